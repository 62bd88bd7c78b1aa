#pragma once

#include <string>

#include "command_line/program.hpp"

namespace adit::applier {

/// adit-spare's command line.
struct SpareOptions {
  std::string wanted = "/var/lib/private/adit";  // where aditd asks
  std::string status = "/run/adit-spare";        // where it is answered, for everybody to read
  std::string sticks = "/run/adit-stick";        // in whose folders USB sticks are mounted
  std::string block = "/sys/class/block";        // where the kernel tells of disks
  std::string devices = "/dev";                  // where they are
  std::string mount = "systemd-mount";           // mounts them, and takes --umount
  bool help = false, version = false;
};

[[gnu::cold]] command_line::Program spare_command_line_of(SpareOptions& options);

}  // namespace adit::applier
