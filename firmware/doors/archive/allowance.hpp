#pragma once

#include <algorithm>
#include <cstddef>

#include "archive/framed_records.hpp"
#include "loop/loop.hpp"

namespace adit::archive {

/// Limits writes to less than 1 MB in any minute, over all files. The unused part may grow to one record, so
/// that every record can be written, and no write is larger.
class Allowance {
 public:
  static constexpr double kASecond = 14000;  // bytes per second
  static constexpr double kMost = kLargestRecord + 1024;

  /// Bytes that may be written at `now`, which must not run back.
  std::size_t at(loop::Instant now) {
    if (last_ == loop::Instant{}) last_ = now;
    const double passed = std::chrono::duration<double>(now - last_).count();
    left_ = std::min(kMost, left_ + passed * kASecond);
    last_ = now;
    return static_cast<std::size_t>(std::max(left_, 0.0));
  }
  /// Records a write, done or planned.
  void spend(std::size_t bytes) { left_ -= static_cast<double>(bytes); }

 private:
  double left_ = kMost;
  loop::Instant last_{};
};

}  // namespace adit::archive
