#pragma once

#include <string>

#include "command_line/program.hpp"

namespace adit::applier {

/// adit-spare's command line.
struct SpareOptions {
  std::string wanted = "/var/lib/private/adit";  // directory of aditd's requests
  std::string status = "/run/adit-spare";        // directory of the status, readable by all
  std::string sticks = "/run/adit-stick";        // directory of the mount points
  std::string block = "/sys/class/block";        // the kernel's list of disks
  std::string devices = "/dev";                  // device files
  std::string mount = "systemd-mount";           // mounts, and unmounts with --umount
  bool help = false, version = false;
};

[[gnu::cold]] command_line::Program spare_command_line_of(SpareOptions& options);

}  // namespace adit::applier
