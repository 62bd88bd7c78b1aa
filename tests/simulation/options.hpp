#pragma once

#include "command_line/read.hpp"
#include "simulation/omissions.hpp"

namespace adit::simulation {

struct Options {
  std::uint64_t seed = 0, runs = 0;
  double hours = 0, cpu = 0;  // 0: no limit
  std::uint64_t jobs = 1;
  Omissions without;
  bool log = false, story = false, as_it_is = false, help = false;
  std::string until;
};

command_line::Program command_line_of(Options& options);
std::expected<Options, std::string> read_options(std::span<const char* const> arguments);

}  // namespace adit::simulation
