#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "loop/loop.hpp"

namespace adit::uplink {

/// When to connect next. The pause between two attempts doubles while they fail.
class ConnectAttempts {
 public:
  void begins(loop::Instant now) { began_ = now; }
  void succeeded() {
    trouble_.clear();
    hurry();
  }
  /// Returns the time of the next attempt.
  loop::Instant failed(std::string why) {
    trouble_ = std::move(why);
    return began_ + std::exchange(pause_, std::min(pause_ * 2, kLongestPause));
  }
  /// The link may be back: the next pause is short.
  void hurry() { pause_ = kFirstPause; }
  loop::Instant next() const { return began_ + pause_; }
  /// Why the last attempt failed, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  static constexpr std::chrono::seconds kFirstPause{1}, kLongestPause{5};

  loop::Instant began_;  // the last attempt
  std::chrono::seconds pause_ = kFirstPause;
  std::string trouble_;
};

}  // namespace adit::uplink
