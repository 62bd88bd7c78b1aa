// Plays runs of the whole gateway in a simulated world, from seeds.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

#include "command_line/read.hpp"
#include "simulation/omissions.hpp"
#include "simulation/options.hpp"
#include "simulation/run.hpp"

namespace adit::simulation {
namespace {

/// Sums over many runs, as plain numbers, because one process passes them to another.
struct Tally {
  std::uint64_t runs = 0, events = 0, faults = 0, failed = 0;
  double hours = 0;  // simulated
  double cpu = 0;    // seconds

  void add(const Outcome& outcome);
  void add(const Tally& other);
  std::string sentence(std::uint64_t first_seed) const;
};

void Tally::add(const Outcome& outcome) {
  ++runs;
  events += outcome.steps;
  faults += outcome.faults;
  hours += outcome.seconds / 3600;
}

void Tally::add(const Tally& other) {
  runs += other.runs;
  events += other.events;
  faults += other.faults;
  failed += other.failed;
  hours += other.hours;
  cpu += other.cpu;
}

std::string Tally::sentence(std::uint64_t first_seed) const {
  char text[256];
  std::snprintf(
      text, sizeof text,
      "%llu runs from seed %llu: %.2f simulated hours, %llu events, %llu faults, %.1f s of CPU, %llu failed",
      static_cast<unsigned long long>(runs), static_cast<unsigned long long>(first_seed), hours,
      static_cast<unsigned long long>(events), static_cast<unsigned long long>(faults), cpu,
      static_cast<unsigned long long>(failed));
  return text;
}

class Shrinking {
 public:
  Shrinking(std::uint64_t seed, Omissions from, std::string broken, int most_plays)
      : seed_(seed), without_(std::move(from)), broken_(std::move(broken)), plays_left_(most_plays) {}

  Omissions result() {
    for (const auto& [actor, actions] : actions()) try_without_all(actor);
    for (bool smaller = true; smaller && plays_left_ > 0;) {
      smaller = false;
      for (const auto& [actor, actions] : actions()) smaller = try_ranges(actor, actions) || smaller;
    }
    return without_;
  }

 private:
  Actions actions() const { return play({.seed = seed_, .without = without_}).actions; }

  /// Keeps the omissions `next` if the same check still fails with the same sentence.
  bool still_breaks(Omissions next) {
    if (plays_left_-- <= 0) return false;
    const auto broken = play({.seed = seed_, .without = next}).broken;
    const bool breaks = std::ranges::find(broken, broken_) != broken.end();
    if (breaks) without_ = std::move(next);
    return breaks;
  }

  void try_without_all(const std::string& actor) {
    Omissions next = without_;
    next.add_all(actor);
    still_breaks(std::move(next));
  }

  /// Tries to leave out halves, quarters and so on, down to single actions.
  bool try_ranges(const std::string& actor, std::uint64_t actions) {
    bool smaller = false;
    for (std::uint64_t size = (actions + 1) / 2; size > 0 && plays_left_ > 0;
         size = size == 1 ? 0 : (size + 1) / 2) {
      for (std::uint64_t first = 1; first <= actions; first += size)
        smaller = try_range(actor, first, std::min(first + size - 1, actions)) || smaller;
    }
    return smaller;
  }

  bool try_range(const std::string& actor, std::uint64_t first, std::uint64_t last) {
    while (first <= last && without_.has(actor, first)) ++first;
    while (first <= last && without_.has(actor, last)) --last;
    if (first > last) return false;
    Omissions next = without_;
    next.add(actor, first, last);
    return still_breaks(std::move(next));
  }

  const std::uint64_t seed_;
  Omissions without_;
  const std::string broken_;
  int plays_left_;
};

/// Shrinks a failing run: leaves out everything without which the same check still fails with the same
/// sentence, because another sentence may have another cause. Tries whole actors first, then ranges, then
/// single actions. Each try plays the run again, at most `most_plays` times.
Omissions shrunk(std::uint64_t seed, const Omissions& from, const std::string& broken, int most_plays) {
  return Shrinking(seed, from, broken, most_plays).result();
}

constexpr int kMostPlays = 400;  // tries to shrink one run
constexpr std::uint64_t kPlayedTwice = 100;

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

std::string replay(std::uint64_t seed, const Omissions& without) {
  std::string command = "tests/simulation/run --seed " + std::to_string(seed);
  if (!without.empty()) command += " --without \"" + without.words() + '"';
  return command + " --log";
}

/// One of several processes. It plays every `jobs`th seed from its own first seed.
class Job {
 public:
  Job(const Options& options, std::uint64_t number) : options_(options), number_(number) {}

  Tally result() {
    const std::uint64_t jobs = options_.jobs;
    for (std::uint64_t i = number_; i < options_.runs && has_time() && !found_; i += jobs)
      try_one(options_.seed + i);
    tally_.cpu = cpu_seconds();
    return tally_;
  }

 private:
  bool has_time() const {
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began_;
    if (options_.hours > 0 && took.count() > options_.hours * 3600) return false;
    return options_.cpu <= 0 || cpu_seconds() <= options_.cpu;
  }

  /// Counts an exception of the simulation itself as a failure.
  void try_one(std::uint64_t seed) {
    try {
      one(seed);
    } catch (const std::exception& unexpected) {
      ++tally_.failed;
      std::printf("seed %llu: broke off: %s\n", static_cast<unsigned long long>(seed), unexpected.what());
    }
  }

  void one(std::uint64_t seed) {
    const Telling tells = options_.log ? Telling::All : options_.story ? Telling::Story : Telling::Nothing;
    const Outcome outcome = play({.seed = seed, .without = options_.without, .tells = tells});
    tally_.add(outcome);
    for (const std::string& broken : outcome.broken) {
      std::printf("seed %llu: %s\n", static_cast<unsigned long long>(seed), broken.c_str());
      found_ = found_ || broken.starts_with(options_.until + ':');
    }
    const bool same = tally_.runs % kPlayedTwice != 1 || is_the_same_again(seed, outcome.hash);
    const bool good = outcome.broken.empty() && same;
    if (!good || tells != Telling::Nothing) {
      std::printf("seed %llu: faults %s; history %016llx; replay: %s\n",
                  static_cast<unsigned long long>(seed), outcome.drawn.c_str(),
                  static_cast<unsigned long long>(outcome.hash), replay(seed, options_.without).c_str());
    }
    if (good) return;
    ++tally_.failed;
    if (!outcome.broken.empty() && !options_.as_it_is && !shrunk_) tell_shrunk(seed, outcome.broken.front());
    std::fflush(stdout);
  }

  bool is_the_same_again(std::uint64_t seed, std::uint64_t hash) const {
    if (play({.seed = seed, .without = options_.without}).hash == hash) return true;
    std::printf("seed %llu: played twice, it was not the same\n", static_cast<unsigned long long>(seed));
    return false;
  }

  /// Shrinks the first failing run only, because that takes as long as hundreds of runs.
  void tell_shrunk(std::uint64_t seed, const std::string& broken) {
    shrunk_ = true;
    const Omissions without = shrunk(seed, options_.without, broken, kMostPlays);
    std::printf("\nseed %llu, shrunk:\n", static_cast<unsigned long long>(seed));
    for (const std::string& each : play({.seed = seed, .without = without, .tells = Telling::Story}).broken)
      std::printf("%s\n", each.c_str());
    std::printf("replay: %s\n\n", replay(seed, without).c_str());
  }

  const Options& options_;
  const std::uint64_t number_;
  const std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  Tally tally_;
  bool found_ = false;  // the check of --until has failed
  bool shrunk_ = false;
};

/// Plays each job in a process of its own, because a process can have one world.
bool play_all(const Options& options, Tally& tally) {
  std::array<int, 2> results{};
  if (::pipe(results.data()) != 0) return false;
  for (std::uint64_t number = 0; number < options.jobs; ++number) {
    if (::fork() != 0) continue;
    const Tally mine = Job(options, number).result();
    std::fflush(stdout);
    _exit(::write(results[1], &mine, sizeof mine) == sizeof mine ? 0 : 1);
  }
  bool well = true;
  int status = 0;
  while (::wait(&status) > 0) {
    if (WIFSIGNALED(status)) std::printf("a job died of signal %d\n", WTERMSIG(status));
    well = well && status == 0;
  }
  ::close(results[1]);
  for (Tally each; ::read(results[0], &each, sizeof each) == sizeof each;) tally.add(each);
  return well;
}

}  // namespace

}  // namespace adit::simulation

int main(int argc, char** argv) {
  using namespace adit::simulation;
  const auto options = read_options({argv + 1, argv + argc});
  if (const auto exit = adit::command_line::answer(command_line_of, "", options)) return *exit;
  Tally tally;
  bool well = true;
  if (options->jobs > 1) {
    well = play_all(*options, tally);
  } else {
    tally = Job(*options, 0).result();
  }
  std::printf("%s\n", tally.sentence(options->seed).c_str());
  return well && tally.failed == 0 ? 0 : 1;
}
