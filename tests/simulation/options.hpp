#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "simulation/omissions.hpp"

namespace adit::simulation {

inline constexpr const char* kUsage =
    "adit_simulation [--seed N] [--runs N] [--hours H] [--cpu SECONDS] [--jobs N] [--without WORDS] [--log | "
    "--story]\n"
    "                [--until CHECK] [--as-it-is]\n"
    "  --seed N        the first seed; a fresh one without it\n"
    "  --runs N        so many runs; 1, or until the time is up\n"
    "  --hours H, --cpu SECONDS\n"
    "                  no run begins after so much time, or so much CPU of one job\n"
    "  --jobs N        so many processes, each with seeds of its own\n"
    "  --without WORDS what is left out of the runs, as a shrunk run's replay says\n"
    "  --log           each event; --story: without what is of every run\n"
    "  --until CHECK   ends where that check finds something\n"
    "  --as-it-is      a run that fails is not shrunk\n";

struct Options {
  std::uint64_t seed = 0;
  std::uint64_t runs = 1;
  double hours = 0, cpu = 0;  // 0: no such limit
  std::uint64_t jobs = 1;
  Omissions without;
  bool log = false, story = false, as_it_is = false;
  std::string until;
};

/// None: no such options.
std::optional<Options> read_options(int argc, char** argv);

}  // namespace adit::simulation
