#pragma once

#include "command_line/read.hpp"

namespace adit::gateway {

struct Options {
  std::string settings, secrets, state;
  std::string network = "/run/adit-network", update = "/run/adit-update", clock = "/run/adit-clock",
              spare = "/run/adit-spare";
  std::string watch = "/run/adit-network-watch", ports = "/run/adit-ports";
  std::string board;  // or ""
  std::string panel;  // adit-panel's socket, or ""
  std::string notices = "/run/adit-notices";
  std::string block = "/sys/dev/block";
  bool help = false, version = false;
};

[[gnu::cold]] command_line::Program command_line_of(Options& options);

}  // namespace adit::gateway
