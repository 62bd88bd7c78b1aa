#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <expected>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "command_line/read.hpp"
#include "rehearsal/robots/cave.hpp"
#include "rehearsal/robots/client.hpp"
#include "rehearsal/robots/explorer.hpp"
#include "rehearsal/robots/maps/map_file.hpp"
#include "rehearsal/robots/options.hpp"

namespace adit::robots {
namespace {

/// Standard output, shared by the team's threads: lines that stay, and on a terminal one live line below
/// them.
class Console {
 public:
  explicit Console(bool quiet);

  bool is_terminal() const { return terminal_; }
  /// A line that stays.
  void say(const std::string& line);
  /// The live line on a terminal, else a line that stays.
  void live(const std::string& line);
  /// Also where quiet.
  void finish(const std::string& text);

 private:
  const bool quiet_;
  const bool terminal_;
  std::mutex mutex_;  // guards all below, and stdout
  std::string live_;
};

/// The team at work: a thread for each robot, one for the operator, one that replays map files.
class Team {
 public:
  /// All but `token` and `maps` outlive the team. `maps`: files that the robot `replay` posts.
  Team(const Options& options, const std::string& token, std::vector<std::filesystem::path> maps,
       const Cave& cave, Tally& tally, Posted& posted, Console& console);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  void start();

  /// Whether every map file has been posted.
  bool replay_done() const { return replay_done_; }

  /// Ends the run: answers on their way are waited for up to `grace`, then given up.
  void stop(std::chrono::milliseconds grace);

 private:
  template <class Work>
  void run(Work work);
  void explore(std::size_t index);
  void replay();

  const Options& options_;
  const Post post_;
  const std::vector<std::filesystem::path> maps_;
  const Cave& cave_;
  Tally& tally_;
  Posted& posted_;
  Console& console_;
  OperatorDesk desk_;
  std::stop_source finish_, abort_;
  std::atomic<int> working_ = 0;
  std::atomic<bool> replay_done_ = false;
  std::vector<std::jthread> threads_;
};

/// Posts one map file, and again after a 429 or without an answer. Then waits as long as a client that keeps
/// to one map a second. Returns a line about the answer, or the fault of the file.
std::expected<std::string, std::string> replay_file(const std::filesystem::path& file, Client& client,
                                                    const std::stop_token& finish) {
  constexpr std::chrono::milliseconds kBetween{1100};
  auto map = load_map(file);
  if (!map) return std::unexpected(map.error());
  const std::chrono::duration<double> now = std::chrono::system_clock::now().time_since_epoch();
  const Message message = std::visit(
      [&](auto& loaded) -> Message {
        loaded.stamp = now.count();
        return std::move(loaded);
      },
      *map);
  while (!finish.stop_requested()) {
    const auto reply = client.send(message);
    pause_until(std::chrono::steady_clock::now() + kBetween, finish);
    if (reply && reply->status != 429) {
      return "replay posts " + file.string() + ": " + std::to_string(reply->status);
    }
  }
  return "replay did not post " + file.string();
}

constexpr double kMetresPerSecond = 2;
constexpr const char* kClearLine = "\r\033[K";

void print(const std::string& text) {
  (void)std::fwrite(text.data(), 1, text.size(), stdout);
  (void)std::fflush(stdout);
}

Console::Console(bool quiet) : quiet_(quiet), terminal_(isatty(STDOUT_FILENO) == 1) {}

void Console::say(const std::string& line) {
  if (quiet_) return;
  const std::scoped_lock lock(mutex_);
  print(live_.empty() ? line + "\n" : kClearLine + line + "\n" + live_);
}

void Console::live(const std::string& line) {
  if (quiet_) return;
  const std::scoped_lock lock(mutex_);
  if (terminal_) {
    live_ = line;
    print(kClearLine + line);
  } else {
    print(line + "\n");
  }
}

void Console::finish(const std::string& text) {
  const std::scoped_lock lock(mutex_);
  print((live_.empty() ? "" : kClearLine) + text);
  live_.clear();
}

Team::Team(const Options& options, const std::string& token, std::vector<std::filesystem::path> maps,
           const Cave& cave, Tally& tally, Posted& posted, Console& console)
    : options_(options),
      post_{.mapping = options.post, .scoring = options.scoring, .token = token},
      maps_(std::move(maps)),
      cave_(cave),
      tally_(tally),
      posted_(posted),
      console_(console),
      desk_(post_, options.style.of(0), tally, [&console](const std::string& line) { console.say(line); }) {}

Team::~Team() {
  stop(std::chrono::milliseconds(0));
}

template <class Work>
void Team::run(Work work) {
  ++working_;
  threads_.emplace_back([this, work = std::move(work)] {
    try {
      work();
    } catch (const std::exception& error) {  // memory, or a socket that cannot even be made
      tally_.failed(error.what());
    }
    --working_;
  });
}

void Team::start() {
  for (std::size_t index = 0; index < options_.robots; ++index) run([this, index] { explore(index); });
  if (options_.robots > 0) run([this] { desk_.work(finish_.get_token(), abort_.get_token()); });
  run([this] { replay(); });
}

void Team::explore(std::size_t index) {
  const std::string name = std::string("r").append(std::to_string(index + 1));
  const Style& style = options_.style.of(index);
  Client client(post_, name, style, tally_, abort_.get_token());
  Explorer explorer(cave_, options_.seed, index, name, style, options_.offers.of(index), client, desk_,
                    posted_);
  explorer.work(kMetresPerSecond * options_.speed, finish_.get_token());
}

void Team::replay() {
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    Client client(post_, "replay", options_.style.of(i), tally_, abort_.get_token());
    if (auto said = replay_file(maps_[i], client, finish_.get_token()); said) {
      console_.say(*said);
    } else {
      tally_.failed(said.error());
      console_.say(said.error());
    }
  }
  replay_done_ = !finish_.stop_requested();
}

void Team::stop(std::chrono::milliseconds grace) {
  finish_.request_stop();
  const auto until = std::chrono::steady_clock::now() + grace;
  while (working_ > 0 && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  abort_.request_stop();
  threads_.clear();  // joins
}

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
