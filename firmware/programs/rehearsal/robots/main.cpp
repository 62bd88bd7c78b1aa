// adit-robots: a simulated team.

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>
#include <expected>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "command_line/read.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "rehearsal/common.hpp"
#include "rehearsal/robots/cave.hpp"
#include "rehearsal/robots/client.hpp"
#include "rehearsal/robots/explorer.hpp"
#include "rehearsal/robots/maps/map_file.hpp"
#include "rehearsal/robots/options.hpp"

namespace adit::robots {
namespace {

using Clock = std::chrono::steady_clock;

/// Standard output of the team's threads: lines that stay, and on a terminal one live line below them.
class Console {
 public:
  explicit Console(bool quiet) : quiet_(quiet) {}

  bool is_terminal() const { return terminal_; }

  /// A line that stays.
  void print_line(const std::string& line) {
    if (quiet_) return;
    const std::scoped_lock lock(mutex_);
    print(live_.empty() ? line + "\n" : kClearLine + line + "\n" + live_);
  }

  /// The live line on a terminal, else a line that stays.
  void show_live_line(const std::string& line) {
    if (quiet_) return;
    const std::scoped_lock lock(mutex_);
    print(terminal_ ? kClearLine + line : line + "\n");
    if (terminal_) live_ = line;
  }

  /// Also where quiet.
  void finish(const std::string& text) {
    const std::scoped_lock lock(mutex_);
    print((live_.empty() ? "" : kClearLine) + text);
    live_.clear();
  }

 private:
  static constexpr const char* kClearLine = "\r\033[K";

  const bool quiet_;
  const bool terminal_ = isatty(STDOUT_FILENO) == 1;
  std::mutex mutex_;  // guards all below, and stdout
  std::string live_;
};

/// Posts one map file, and again after a 429 or without an answer. Then waits as long as a client that keeps
/// to one map a second. Returns a line about the answer, or the fault of the file.
std::expected<std::string, std::string> replay_file(const std::filesystem::path& file, Client& client,
                                                    const std::stop_token& finish) {
  constexpr std::chrono::milliseconds kBetween{1100};
  LoadedMap map = ADIT_TRY(load_map(file));
  const std::chrono::duration<double> now = std::chrono::system_clock::now().time_since_epoch();
  std::visit([&](auto& loaded) { loaded.stamp = now.count(); }, map);
  const Message message = std::visit([](auto& loaded) -> Message { return std::move(loaded); }, map);
  while (!finish.stop_requested()) {
    const auto reply = client.send(message);
    sleep_until(Clock::now() + kBetween, finish);
    if (reply && reply->status != 429)
      return icd::sentence("replay posts ", file.string(), ": ", reply->status);
  }
  return "replay did not post " + file.string();
}

/// The team at work: a thread for each robot, one for the operator, one that replays map files.
class Team {
 public:
  /// All but `token` outlive the team.
  Team(const Options& options, const std::string& token, const Cave& cave, Tally& tally, PostedTotals& posted,
       Console& console)
      : options_(options),
        post_{.mapping = options.post, .scoring = options.scoring, .token = token},
        cave_(cave),
        tally_(tally),
        posted_(posted),
        console_(console),
        desk_(post_, options.style.style_of(0), tally,
              [&console](const std::string& line) { console.print_line(line); }) {
    for (std::size_t index = 0; index < options.robots; ++index) run([this, index] { explore(index); });
    if (options.robots > 0) run([this] { desk_.work(finish_.get_token(), abort_.get_token()); });
    run([this] { replay(); });
  }
  ~Team() { stop(std::chrono::milliseconds(0)); }
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// Whether every map file has been posted.
  bool replay_done() const { return replay_done_; }

  /// Ends the run: answers on their way are waited for up to `grace`, then given up.
  void stop(std::chrono::milliseconds grace) {
    finish_.request_stop();
    const auto until = Clock::now() + grace;
    while (working_ > 0 && Clock::now() < until) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    abort_.request_stop();
    threads_.clear();  // joins
  }

 private:
  template <class Work>
  void run(Work work) {
    ++working_;
    threads_.emplace_back([this, work = std::move(work)] {
      try {
        work();
      } catch (const std::exception& error) {  // memory, or a socket that cannot even be made
        tally_.count_failure(error.what());
      }
      --working_;
    });
  }

  void explore(std::size_t index) {
    constexpr double kMetresPerSecond = 2;
    const std::string name = icd::sentence("r", index + 1);
    const Style& style = options_.style.style_of(index);
    Client client(post_, name, style, tally_, abort_.get_token());
    Explorer explorer(cave_, options_.seed, index, name, style, options_.offers.offer_of(index), client,
                      desk_, posted_);
    explorer.work(kMetresPerSecond * options_.speed, finish_.get_token());
  }

  void replay() {
    for (std::size_t i = 0; i < options_.maps.size(); ++i) {
      Client client(post_, "replay", options_.style.style_of(i), tally_, abort_.get_token());
      const auto said = replay_file(options_.maps[i], client, finish_.get_token());
      if (!said) tally_.count_failure(said.error());
      console_.print_line(said ? *said : said.error());
    }
    replay_done_ = !finish_.stop_requested();
  }

  const Options& options_;
  const Post post_;
  const Cave& cave_;
  Tally& tally_;
  PostedTotals& posted_;
  Console& console_;
  OperatorClient desk_;
  std::stop_source finish_, abort_;
  std::atomic<int> working_ = 0;
  std::atomic<bool> replay_done_ = false;
  std::vector<std::jthread> threads_;
};

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

/// Waits up to 100 ms for one of them.
bool wait_for_signal(const sigset_t& signals) {
  constexpr timespec kWait{.tv_sec = 0, .tv_nsec = 100'000'000};
  return sigtimedwait(&signals, nullptr, &kWait) > 0;
}

std::vector<MessageKind> kinds_to_post(const Options& options) {
  std::vector<MessageKind> kinds;
  if (options.robots == 0) {
    for (const auto& map : options.maps)
      kinds.push_back(map.extension() == ".pgm" ? MessageKind::Grid : MessageKind::Cloud);
    return kinds;
  }
  kinds = {MessageKind::State, MessageKind::Markers, MessageKind::Report, MessageKind::Status};
  if (options.offers.has_grids()) kinds.push_back(MessageKind::Grid);
  if (options.offers.has_clouds()) kinds.push_back(MessageKind::Cloud);
  return kinds;
}

bool has_posted_all(const std::vector<MessageKind>& kinds, const Tally& tally) {
  return std::ranges::all_of(kinds, [&](MessageKind kind) { return tally.accepted_of(kind) > 0; });
}

/// Until the time is over, all is posted, or a signal comes; and how long then to wait for answers.
std::chrono::milliseconds watch(const Options& options, const std::vector<MessageKind>& kinds,
                                const Team& team, const Tally& tally, Console& console,
                                const sigset_t& signals) {
  constexpr std::chrono::milliseconds kGrace{2000};
  const std::chrono::seconds every{console.is_terminal() ? 1 : 5};
  const Clock::time_point start = Clock::now();
  Clock::time_point next_line = start + every;
  while (!wait_for_signal(signals)) {
    const Clock::time_point now = Clock::now();
    if (options.run_for && now - start >= *options.run_for) return kGrace;
    if (options.stop_when_posted && team.replay_done() && has_posted_all(kinds, tally)) return kGrace;
    if (now >= next_line) {
      next_line += every;
      const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(now - start).count();
      console.show_live_line(icd::sentence(seconds, " s: ", tally.line()));
    }
  }
  return std::chrono::milliseconds{0};
}

int run(const Options& options, const Cave& cave) {
  const sigset_t signals = block_signals({SIGINT, SIGTERM});
  const auto token = read_token(std::filesystem::path(options.secrets) / "team.token");
  if (!token) return complain(token.error());
  const std::vector<MessageKind> kinds = kinds_to_post(options);
  Tally tally;
  PostedTotals posted;
  Console console(options.quiet);
  Team team(options, *token, cave, tally, posted, console);
  team.stop(watch(options, kinds, team, tally, console, signals));
  console.finish(tally.summary());
  if (options.control) console.finish(arrivals_of(posted, *options.control));
  for (const MessageKind kind : kinds) {
    if (tally.accepted_of(kind) == 0) console.finish(icd::sentence("no ", name_of(kind), " was accepted\n"));
  }
  return tally.clean() && has_posted_all(kinds, tally) ? kGood : kNotAllPosted;
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
