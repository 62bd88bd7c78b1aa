#pragma once

#include <cstdint>
#include <utility>

#include "loop/loop.hpp"

namespace adit::intake {

/// Checks that bytes move at least as fast as on a slow radio: kLeast over each `window`, checked twice per
/// window. A client that stops is found within one and a half windows.
class LeastRate {
 public:
  static constexpr std::uint64_t kLeast = 1000;  // bytes a second

  LeastRate(loop::Duration window, loop::Instant now) : half_(window / 2), look_at_(now + half_) {}

  void moved(std::uint64_t bytes) { in_this_half_ += bytes; }
  loop::Instant look_at() const { return look_at_; }
  /// Call this once for each look_at(), at that time or later.
  bool is_too_slow(loop::Instant now) {
    const bool is_full = std::exchange(has_half_, true);
    const std::uint64_t moved = in_last_half_ + in_this_half_;
    in_last_half_ = std::exchange(in_this_half_, 0);
    look_at_ = now + half_;
    const std::chrono::duration<double> both = 2 * half_;
    return is_full && static_cast<double>(moved) < kLeast * both.count();
  }

 private:
  loop::Duration half_;
  loop::Instant look_at_;
  std::uint64_t in_last_half_ = 0, in_this_half_ = 0;
  bool has_half_ = false;  // in_last_half_ is set
};

}  // namespace adit::intake
