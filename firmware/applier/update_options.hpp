#pragma once

#include "command_line/program.hpp"
#include "update/health.hpp"

namespace adit::applier {

/// adit-update's command line.
struct UpdateOptions {
  std::string wanted = "/var/lib/private/adit";       // where aditd asks
  std::string status = "/run/adit-update";            // where it is answered, for everybody to read
  std::string state = "/var/lib/adit-update";         // what became of the last update
  std::string sticks = "/run/adit-stick";             // in whose folders USB sticks are mounted
  std::string os_release = "/etc/os-release";         // says which version runs
  std::string hindrance = "/run/adit-notices/disks";  // why none may be installed, where it is there
  std::string rauc = "rauc", systemctl = "systemctl";
  std::chrono::seconds within = update::kGoodWithin;  // of `good`
  bool good = false;  // watches the start of the machine, rather than doing what is asked for
  bool help = false, version = false;
};

[[gnu::cold]] command_line::Program update_command_line_of(UpdateOptions& options);

}  // namespace adit::applier
