#pragma once

#include <deque>
#include <functional>
#include <utility>

namespace adit::intake {

/// Gives turns, first come first served: for what takes too much memory to be done twice at once. For the
/// loop alone.
class OneAtATime {
 public:
  /// Calls `begin` when it is its turn, maybe at once. Whoever has a turn ends it.
  void wait(std::function<void()> begin) {
    waiting_.push_back(std::move(begin));
    go_on();
  }
  void end() {
    under_way_ = false;
    go_on();
  }

 private:
  void go_on() {
    if (under_way_ || waiting_.empty()) return;
    under_way_ = true;
    const auto begin = std::move(waiting_.front());
    waiting_.pop_front();
    begin();
  }

  std::deque<std::function<void()>> waiting_;
  bool under_way_ = false;
};

}  // namespace adit::intake
