#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <string>
#include <utility>

namespace adit::intake {

/// Gives turns for work that needs too much memory to be done twice at once. Addresses take turns; each
/// address has its turns in order of arrival. For the loop only.
class TurnQueue {
 public:
  /// Calls `begin` when its turn comes, maybe at once. The caller ends the turn with end().
  void wait(const std::string& address, std::function<void()> begin) {
    auto line = std::ranges::find(lines_, address, &Line::address);
    if (line == lines_.end()) line = lines_.insert(line, {.address = address, .waiting = {}});
    line->waiting.push_back(std::move(begin));
    go_on();
  }
  void end() {
    under_way_ = false;
    go_on();
  }

 private:
  struct Line {
    std::string address;
    std::deque<std::function<void()>> waiting;  // not empty
  };

  void go_on() {
    if (under_way_ || lines_.empty()) return;
    under_way_ = true;
    Line first = std::move(lines_.front());
    lines_.pop_front();
    const auto begin = std::move(first.waiting.front());
    first.waiting.pop_front();
    if (!first.waiting.empty()) lines_.push_back(std::move(first));
    begin();
  }

  std::deque<Line> lines_;
  bool under_way_ = false;
};

}  // namespace adit::intake
