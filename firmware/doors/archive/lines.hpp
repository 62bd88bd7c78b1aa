#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <string>

#include "archive/framed_records.hpp"
#include "loop/loop.hpp"

namespace adit::archive {

/// Queued records of tracks, plots and events. Each write costs a flush of the disk, so records without news
/// go with the next write, or after kRest.
class Lines {
 public:
  static constexpr std::chrono::seconds kRest{150};
  /// Most bytes of queued records, because a disk may be slow. Beyond that the oldest are dropped.
  static constexpr std::size_t kMost = std::size_t{256} << 10;

  /// News: a robot moved, or an alarm began or ended. Others show only that time passed.
  void add(std::string record, bool is_news);
  /// The oldest records, for one write.
  std::string take(loop::Instant now);
  /// After a failed write of take(): they are due at once.
  void give_back(std::string records);
  void be_due() { is_due_ = true; }
  bool is_due(loop::Instant now) const { return bytes_ > 0 && (is_due_ || now >= rests_until_); }
  void keep_below(std::size_t most);
  std::size_t bytes() const { return bytes_; }

 private:
  std::deque<std::string> records_;  // oldest first
  std::size_t bytes_ = 0;
  bool is_due_ = false;
  loop::Instant rests_until_{};
};

}  // namespace adit::archive
