#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "rehearsal/robots/cave.hpp"
#include "rehearsal/robots/client.hpp"
#include "rehearsal/robots/explorer.hpp"
#include "rehearsal/robots/options.hpp"

namespace adit::robots {

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

}  // namespace adit::robots
