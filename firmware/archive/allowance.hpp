#pragma once

#include <algorithm>
#include <cstddef>

#include "archive/record.hpp"
#include "loop/loop.hpp"

namespace adit::archive {

/// How much may be written: in any minute less than 1 MB, over all files. What is left may be as large as one
/// record, so that each has its turn, and one write is never larger.
class Allowance {
 public:
  static constexpr double kASecond = 14000;  // bytes
  static constexpr double kMost = kLargestRecord + 1024;

  /// Bytes that may be written at `now`, which never runs back.
  std::size_t at(loop::Instant now) {
    if (last_ == loop::Instant{}) last_ = now;
    const double passed = std::chrono::duration<double>(now - last_).count();
    left_ = std::min(kMost, left_ + passed * kASecond);
    last_ = now;
    return static_cast<std::size_t>(std::max(left_, 0.0));
  }
  /// So many were written, or will be.
  void spend(std::size_t bytes) { left_ -= static_cast<double>(bytes); }

 private:
  double left_ = kMost;
  loop::Instant last_{};
};

}  // namespace adit::archive
