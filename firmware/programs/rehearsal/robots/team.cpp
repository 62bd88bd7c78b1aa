#include "rehearsal/robots/team.hpp"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <expected>
#include <utility>

#include "rehearsal/robots/maps/map_file.hpp"

namespace adit::robots {
namespace {

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

}  // namespace

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

}  // namespace adit::robots
