#pragma once

#include <mutex>
#include <string>

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

}  // namespace adit::robots
