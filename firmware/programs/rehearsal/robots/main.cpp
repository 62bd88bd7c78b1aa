#include <algorithm>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <vector>

#include "command_line/read.hpp"
#include "rehearsal/robots/cave.hpp"
#include "rehearsal/robots/client.hpp"
#include "rehearsal/robots/maps/map_file.hpp"
#include "rehearsal/robots/options.hpp"
#include "rehearsal/robots/team.hpp"

namespace adit::robots {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kGood = 0, kNotAllPosted = 1, kWrongUsage = 2;

int complain(const std::string& what) {
  (void)std::fprintf(stderr, "adit-robots: %s\n", what.c_str());
  return kWrongUsage;
}

bool write_truth(const Cave& cave, const std::filesystem::path& file) {
  std::ofstream stream(file);
  stream << cave.truth_csv() << std::flush;
  return stream.good();
}

/// SIGINT and SIGTERM, taken in the main thread alone. To be called before any other thread begins.
sigset_t block_signals() {
  sigset_t signals;
  (void)sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM}) (void)sigaddset(&signals, signal);
  (void)pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

/// Waits up to 100 ms for one of them.
bool has_come(const sigset_t& signals) {
  constexpr timespec kWait{.tv_sec = 0, .tv_nsec = 100'000'000};
  return sigtimedwait(&signals, nullptr, &kWait) > 0;
}

std::vector<Kind> kinds_to_post(const Options& options, const std::vector<std::filesystem::path>& maps) {
  std::vector<Kind> kinds;
  if (options.robots == 0) {
    for (const auto& map : maps) kinds.push_back(map.extension() == ".pgm" ? Kind::Grid : Kind::Cloud);
    return kinds;
  }
  kinds = {Kind::State, Kind::Markers, Kind::Report, Kind::Status};
  if (options.offers.has_grids()) kinds.push_back(Kind::Grid);
  if (options.offers.has_clouds()) kinds.push_back(Kind::Cloud);
  return kinds;
}

bool all_posted(const std::vector<Kind>& kinds, const Tally& tally) {
  return std::ranges::all_of(kinds, [&](Kind kind) { return tally.accepted_of(kind) > 0; });
}

/// Until the time is over, all is posted, or a signal comes; and how long then to wait for answers.
std::chrono::milliseconds watch(const Options& options, const std::vector<Kind>& kinds, const Team& team,
                                const Tally& tally, Console& console, const sigset_t& signals) {
  constexpr std::chrono::milliseconds kGrace{2000};
  const std::chrono::seconds every{console.is_terminal() ? 1 : 5};
  const Clock::time_point start = Clock::now();
  Clock::time_point next_line = start + every;
  while (!has_come(signals)) {
    const Clock::time_point now = Clock::now();
    if (options.run_for && now - start >= *options.run_for) return kGrace;
    if (options.stop_when_posted && team.replay_done() && all_posted(kinds, tally)) return kGrace;
    if (now >= next_line) {
      next_line += every;
      const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(now - start).count();
      console.live(std::to_string(seconds) + " s: " + tally.line());
    }
  }
  return std::chrono::milliseconds{0};
}

int run(const Options& options, const Cave& cave) {
  const sigset_t signals = block_signals();
  auto token = read_team_token(options.secrets);
  if (!token) return complain(token.error());
  std::vector<std::filesystem::path> maps;
  if (!options.maps.empty()) {
    auto found = find_maps(options.maps);
    if (!found) return complain("--maps: " + found.error());
    if (found->empty()) return complain("--maps: no .pgm, .pcd or .ply under " + options.maps);
    maps = *std::move(found);
  }
  const std::vector<Kind> kinds = kinds_to_post(options, maps);
  Tally tally;
  Posted posted;
  Console console(options.quiet);
  Team team(options, *token, maps, cave, tally, posted, console);
  team.start();
  team.stop(watch(options, kinds, team, tally, console, signals));
  console.finish(tally.summary());
  if (options.control) console.finish(arrivals_of(posted, *options.control));
  for (const Kind kind : kinds) {
    if (tally.accepted_of(kind) == 0) console.finish("no " + std::string(name_of(kind)) + " was accepted\n");
  }
  return tally.clean() && all_posted(kinds, tally) ? kGood : kNotAllPosted;
}

int main_of(std::span<const char* const> arguments) {
  const auto options = parse_options(arguments);
  if (const auto exit = command_line::answer(command_line_of, ADIT_VERSION, options)) return *exit;
  const Cave cave = Cave::generate(options->seed);
  if (!options->truth.empty() && !write_truth(cave, options->truth)) {
    return complain("--truth: cannot write " + options->truth);
  }
  return options->generate_only ? kGood : run(*options, cave);
}

}  // namespace
}  // namespace adit::robots

int main(int argc, char** argv) {
  try {
    return adit::robots::main_of({argv + 1, static_cast<std::size_t>(argc > 0 ? argc - 1 : 0)});
  } catch (const std::exception& error) {
    return adit::robots::complain(error.what());
  }
}
