#pragma once

#include "command_line/program.hpp"
#include "update/health.hpp"

namespace adit::applier {

/// adit-update's command line.
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

[[gnu::cold]] command_line::Program update_command_line_of(UpdateOptions& options);

}  // namespace adit::applier
