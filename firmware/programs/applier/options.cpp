#include "applier/options.hpp"

#include <string_view>
#include <utility>

#include "command_line/program.hpp"

namespace adit::applier {
namespace {

/// The kernel's dev_valid_name(), without characters that systemd.network(5) interprets: patterns, lists,
/// negations.
bool is_interface(std::string_view name) {
  return !name.empty() && name.size() <= 15 && name != "." && name != ".." &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-") ==
             std::string_view::npos;
}

}  // namespace

command_line::Program command_line_of(Options& options) {
  return {
      .name = "adit-network",
      .about =
          "Change the addresses of Adit's two network interfaces by systemd-networkd, on aditd's requests. "
          "Take a change back unless it is confirmed in time. End when no change is pending.",
      .rows = {{"--team", "NAME", "interface to the team", &options.team},
               {"--command-post", "NAME", "interface to the Command Post", &options.command_post},
               {"--wanted", "DIR", "directory of aditd's requests", &options.wanted},
               {"--status", "DIR", "directory of the answers", &options.status},
               {"--state", "DIR", "directory of the confirmed addresses", &options.state},
               {"--factory", "FILE", "addresses if none were confirmed", &options.factory},
               {"--networkd", "DIR", "networkd's directory until the next boot", &options.networkd},
               {"--networkctl", "CMD",
                "command that makes networkd read its files, called with the word reload",
                &options.networkctl},
               {"--start", "", "only write networkd's files, before networkd starts", &options.start},
               {"--watch", "",
                "only write to the directory of --status which other machine uses the box's addresses",
                &options.watch},
               {"--ports", "",
                "only write to the directory of --status the firewall's rules for the ports that aditd "
                "requests",
                &options.ports},
               {"--told", "DIR", "directory from which --watch reads the endpoints", &options.told}},
      .ending =
          "Exit code: 0 if no change is pending; 1 if an error occurred, networkd has not read its files, or "
          "a request cannot be removed or done; 2 for a wrong command line.",
  };
}

std::expected<Options, std::string> parse_options(std::span<const char* const> arguments) {
  const auto options = command_line::read<Options>(command_line_of, arguments);
  if (!options) return options;
  for (const auto& [word, name] :
       {std::pair("--team", options->team), std::pair("--command-post", options->command_post)}) {
    if (!is_interface(name)) return std::unexpected(std::string(word) + ": expected an interface's name");
  }
  if (options->team == options->command_post)
    return std::unexpected("--team and --command-post name the same interface");
  if (options->start + options->watch + options->ports > 1)
    return std::unexpected("--start, --watch and --ports exclude each other");
  return options;
}

command_line::Program command_line_of(UpdateOptions& options) {
  return {
      .name = "adit-update",
      .usage = "[good]",
      .about =
          "Update the box by RAUC, on aditd's requests: check a bundle, install it into the slot that is not "
          "running, and reboot. End when there are no more requests.",
      .rows = {{"good", "",
                "watch a boot instead: mark the slot good once aditd is healthy, or reboot if a slot on "
                "trial does not become healthy",
                &options.good},
               {"--within", "SECONDS", "time that a slot on trial has for this (300)",
                command_line::number<1, 3600>(options.within)},
               {"--wanted", "DIR", "directory of aditd's requests", &options.wanted},
               {"--status", "DIR", "directory of the answers", &options.status},
               {"--state", "DIR", "directory of the last update's outcome", &options.state},
               {"--sticks", "DIR", "directory in which USB sticks are mounted", &options.sticks},
               {"--os-release", "FILE", "file whose VERSION_ID is the running version", &options.os_release},
               {"--hindrance", "FILE", "if this file exists, install no update: it has the reason",
                &options.hindrance},
               {"--rauc", "CMD", "RAUC", &options.rauc},
               {"--systemctl", "CMD", "systemd", &options.systemctl}},
      .ending = "Exit code: 0 on success; 1 if an error occurred; 2 for a wrong command line.",
  };
}

command_line::Program command_line_of(ClockOptions& options) {
  return {
      .name = "adit-clock",
      .about =
          "Set the time of day on aditd's requests, and write which source set it last. If requested, run "
          "chronyd for NTP on the team's network. End when there are no more requests.",
      .rows = {{"--wanted", "DIR", "directory of aditd's requests", &options.wanted},
               {"--status", "DIR", "directory of the answers", &options.status},
               {"--chip", "DIR", "the kernel's directory of a battery-backed clock", &options.chip},
               {"--chip-device", "FILE", "that clock's device, to set it", &options.chip_device},
               {"--team", "NAME", "interface for NTP", &options.team},
               {"--systemctl", "CMD", "systemctl, to start and stop chronyd", &options.systemctl}},
      .ending = "Exit code: 0 on success; 1 if an error occurred; 2 for a wrong command line.",
  };
}

command_line::Program command_line_of(SpareOptions& options) {
  return {
      .name = "adit-spare",
      .about =
          "Write the export for a spare box to the USB stick in the box, and read exports from it, on "
          "aditd's requests. Write which exports are on the stick. End when there are no more requests.",
      .rows = {{"--wanted", "DIR", "directory of aditd's requests", &options.wanted},
               {"--status", "DIR", "directory of the answers", &options.status},
               {"--sticks", "DIR", "directory in which USB sticks are mounted, read-only", &options.sticks},
               {"--block", "DIR", "the kernel's directory of disks", &options.block},
               {"--devices", "DIR", "directory of the disks' devices", &options.devices},
               {"--mount", "CMD", "systemd-mount, to mount sticks", &options.mount}},
      .ending = "Exit code: 0 on success; 1 if an error occurred; 2 for a wrong command line.",
  };
}

command_line::Program command_line_of(CertificateOptions& options) {
  return {
      .name = "adit-certificate",
      .about =
          "Make the certificate of Adit's page for HTTPS, or check an uploaded one, on aditd's requests. End "
          "when there are no more requests.",
      .rows = {{"--state", "DIR", "directory of aditd's requests and of the certificate", &options.state},
               {"--status", "DIR",
                "directory of the answers. The file restart there shows that the certificate has changed",
                &options.status},
               {"--openssl", "CMD", "OpenSSL", &options.openssl}},
      .ending = "Exit code: 0 on success; 1 if an error occurred; 2 for a wrong command line.",
  };
}

command_line::Program command_line_of(ImportOptions& options) {
  return {
      .name = "adit-import",
      .about =
          "Accept the settings, addresses and tokens on Adit's boot partition, if all of them are correct. "
          "Write the outcome to taken.txt beside them. Run it before aditd.",
      .rows =
          {{"--card", "DIR", "directory with settings.json, network.json and secrets/*.token", &options.card},
           {"--state", "DIR", "state directory of aditd", &options.state},
           {"--network", "DIR", "state directory of adit-network", &options.network},
           {"--given", "FILE", "settings in use until others are saved", &options.given},
           {"--memory", "FILE",
            "if this file exists, the state is lost at the next boot, and accepted files stay on the card",
            &options.in_memory}},
      .ending =
          "Exit code: 0 if there are no files, or if they are wrong or accepted; 1 if correct files could "
          "not be stored; 2 for a wrong command line.",
  };
}

}  // namespace adit::applier
