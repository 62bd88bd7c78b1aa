#pragma once

#include "command_line/read.hpp"
#include "update/health.hpp"

namespace adit::applier {

/// adit-network's command line. It names the interfaces, so that a request can change only these two.
struct Options {
  std::string wanted = "/var/lib/private/adit";          // directory of aditd's requests
  std::string status = "/run/adit-network";              // directory of the status, readable by all
  std::string told = "/run/adit-network";                // directory in which the watch reads adit-network's
                                                         // status
  std::string state = "/var/lib/adit-network";           // the confirmed numbers
  std::string networkd = "/run/systemd/network";         // networkd's directory in memory
  std::string factory = "/usr/share/adit/network.json";  // the factory addresses
  std::string networkctl = "networkctl";
  std::string team = "team0", command_post = "darpa0";
  bool start = false;  // writes networkd's files before networkd starts, then exits
  bool watch = false;  // only listens for address conflicts
  bool ports = false;  // only writes the firewall's rules for aditd's ports
  bool help = false, version = false;
};
[[gnu::cold]] command_line::Program command_line_of(Options& options);
/// An error names the wrong word.
[[gnu::cold]] std::expected<Options, std::string> parse_options(std::span<const char* const> arguments);

struct UpdateOptions {
  std::string wanted = "/var/lib/private/adit";       // directory of aditd's requests
  std::string status = "/run/adit-update";            // directory of the status, readable by all
  std::string state = "/var/lib/adit-update";         // result of the last update
  std::string sticks = "/run/adit-stick";             // directory of the mount points
  std::string os_release = "/etc/os-release";         // source of the running version
  std::string hindrance = "/run/adit-notices/disks";  // if it exists, says why updates are blocked
  std::string rauc = "rauc", systemctl = "systemctl";
  std::chrono::seconds within = update::kGoodWithin;  // time limit of `good`
  bool good = false;  // watches the start of the machine instead of answering requests
  bool help = false, version = false;
};
[[gnu::cold]] command_line::Program command_line_of(UpdateOptions& options);

struct ClockOptions {
  std::string wanted = "/var/lib/private/adit";  // directory of aditd's requests
  std::string status = "/run/adit-clock";        // directory of the status, readable by all
  std::string chip = "/sys/class/rtc/rtc0";      // the clock with a battery; may be absent
  std::string chip_device = "/dev/rtc0";
  std::string team = "team0";           // NTP interface
  std::string systemctl = "systemctl";  // controls chronyd
  bool help = false, version = false;
};
[[gnu::cold]] command_line::Program command_line_of(ClockOptions& options);

struct SpareOptions {
  std::string wanted = "/var/lib/private/adit";  // directory of aditd's requests
  std::string status = "/run/adit-spare";        // directory of the status, readable by all
  std::string sticks = "/run/adit-stick";        // directory of the mount points
  std::string block = "/sys/class/block";        // the kernel's list of disks
  std::string devices = "/dev";                  // device files
  std::string mount = "systemd-mount";           // mounts, and unmounts with --umount
  bool help = false, version = false;
};
[[gnu::cold]] command_line::Program command_line_of(SpareOptions& options);

struct CertificateOptions {
  std::string state = "/var/lib/private/adit";   // aditd's state directory: its requests, and tls.pem
  std::string status = "/run/adit/certificate";  // directory of the status
  std::string openssl = "openssl";
  bool help = false, version = false;
};
[[gnu::cold]] command_line::Program command_line_of(CertificateOptions& options);

struct ImportOptions {
  std::string card = "/boot/adit";                    // the user's files
  std::string state = "/var/lib/private/adit";        // of aditd
  std::string network = "/var/lib/adit-network";      // of adit-network
  std::string given = "/etc/adit/settings.json";      // the settings of the image
  std::string in_memory = "/run/adit-notices/state";  // exists if the state is lost at the next boot
  bool help = false, version = false;
};
[[gnu::cold]] command_line::Program command_line_of(ImportOptions& options);

}  // namespace adit::applier
