#pragma once

#include <string>

#include "command_line/program.hpp"

namespace adit::applier {

/// adit-clock's command line.
struct ClockOptions {
  std::string wanted = "/var/lib/private/adit";  // directory of aditd's requests
  std::string status = "/run/adit-clock";        // directory of the status, readable by all
  std::string chip = "/sys/class/rtc/rtc0";      // the clock with a battery; may be absent
  std::string chip_device = "/dev/rtc0";
  std::string team = "team0";           // NTP interface
  std::string systemctl = "systemctl";  // controls chronyd
  bool help = false, version = false;
};

[[gnu::cold]] command_line::Program clock_command_line_of(ClockOptions& options);

}  // namespace adit::applier
