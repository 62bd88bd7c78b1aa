#pragma once

#include <string>

#include "command_line/program.hpp"

namespace adit::applier {

/// adit-clock's command line.
struct ClockOptions {
  std::string wanted = "/var/lib/private/adit";  // where aditd asks
  std::string status = "/run/adit-clock";        // where it is answered, for everybody to read
  std::string chip = "/sys/class/rtc/rtc0";      // the clock with a battery, if there is one
  std::string chip_device = "/dev/rtc0";
  std::string team = "team0";           // the interface on which NTP is spoken
  std::string systemctl = "systemctl";  // starts and stops chronyd
  bool help = false, version = false;
};

[[gnu::cold]] command_line::Program clock_command_line_of(ClockOptions& options);

}  // namespace adit::applier
