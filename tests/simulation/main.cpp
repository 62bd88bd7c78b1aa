// The whole gateway in a simulated world, from seeds.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>

#include "simulation/run.hpp"

namespace {

struct Options {
  std::uint64_t seed = std::random_device{}();
  std::uint64_t runs = 1;
  double cpu = 0;  // seconds, after which no run begins; 0: no such limit
  bool log = false;
  std::string until;  // the check that ends it all where it finds something
};

int usage() {
  std::fputs("adit_simulation [--seed N] [--runs N] [--cpu SECONDS] [--until CHECK] [--log]\n", stderr);
  return 2;
}

bool read(Options& options, int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--log") {
      options.log = true;
      continue;
    }
    if (++i == argc) return false;
    if (word == "--seed") {
      options.seed = std::strtoull(argv[i], nullptr, 10);
    } else if (word == "--runs") {
      options.runs = std::strtoull(argv[i], nullptr, 10);
    } else if (word == "--until") {
      options.until = argv[i];
    } else if (word == "--cpu") {
      options.cpu = std::strtod(argv[i], nullptr);
    } else {
      return false;
    }
  }
  return true;
}

/// Every hundredth run is played twice.
bool replays(std::uint64_t seed, std::uint64_t hash) {
  const std::uint64_t again = adit::simulation::play(seed, false).hash;
  if (again == hash) return true;
  std::printf("seed %llu: played twice, it was not the same\n", static_cast<unsigned long long>(seed));
  return false;
}

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!read(options, argc, argv)) return usage();
  double hours = 0;
  std::uint64_t events = 0, faults = 0, failed = 0, runs = 0;
  for (; runs < options.runs; ++runs) {
    if (options.cpu > 0 && cpu_seconds() > options.cpu) break;
    const std::uint64_t seed = options.seed + runs;
    const auto outcome = adit::simulation::play(seed, options.log);
    hours += outcome.seconds / 3600;
    events += outcome.steps;
    faults += outcome.faults;
    for (const std::string& broken : outcome.broken) {
      std::printf("seed %llu: %s\n", static_cast<unsigned long long>(seed), broken.c_str());
    }
    bool good = outcome.broken.empty();
    if (runs % 100 == 0) good = replays(seed, outcome.hash) && good;
    if (options.log || !good) {
      std::printf("seed %llu: faults %s; history %016llx; replay: tests/simulation/run --seed %llu --log\n",
                  static_cast<unsigned long long>(seed), outcome.drawn.c_str(),
                  static_cast<unsigned long long>(outcome.hash), static_cast<unsigned long long>(seed));
    }
    if (!good) ++failed;
    const auto is_sought = [&](const std::string& broken) { return broken.starts_with(options.until + ":"); };
    if (std::ranges::any_of(outcome.broken, is_sought)) {
      ++runs;
      break;
    }
  }
  std::printf(
      "%llu runs from seed %llu: %.2f simulated hours, %llu events, %llu faults, %.1f s of CPU, %llu "
      "failed\n",
      static_cast<unsigned long long>(runs), static_cast<unsigned long long>(options.seed), hours,
      static_cast<unsigned long long>(events), static_cast<unsigned long long>(faults), cpu_seconds(),
      static_cast<unsigned long long>(failed));
  return failed == 0 ? 0 : 1;
}
