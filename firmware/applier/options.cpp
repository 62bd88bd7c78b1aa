#include "applier/options.hpp"

#include <string_view>
#include <utility>

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
      .usage = "",
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
               {"--told", "DIR", "directory from which --watch reads the endpoints", &options.told},
               {"--version", "", "print the version", &options.version},
               {"--help", "", "print this help", &options.help}},
      .ending =
          "Exit code: 0 if no change is pending; 1 if an error occurred, networkd has not read its files, or "
          "a request cannot be removed or done; 2 for a wrong command line.",
  };
}

std::expected<Options, std::string> parse_options(std::span<const char* const> arguments) {
  const auto options = command_line::read(command_line_of, arguments);
  if (!options) return options;
  for (const auto& [word, name] :
       {std::pair("--team", options->team), std::pair("--command-post", options->command_post)}) {
    if (!is_interface(name)) return std::unexpected(std::string(word) + ": expected an interface's name");
  }
  if (options->team == options->command_post)
    return std::unexpected("--team and --command-post name the same interface");
  if (options->start && options->watch) return std::unexpected("--start and --watch exclude each other");
  return options;
}

}  // namespace adit::applier
