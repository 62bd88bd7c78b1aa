#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/log.hpp"

namespace adit::host {

/// The last records of the log, for those who cannot reach the journal: at most kMost, and of their text at
/// most kMostBytes; the oldest go first. Thread-safe.
class Memory {
 public:
  static constexpr std::size_t kMost = 2000;
  static constexpr std::size_t kMostBytes = 1u << 20;
  static constexpr std::size_t kLongest = 4096;  // of a message or a value; what is longer is cut

  /// `at`: seconds since 1970.
  void keep(double at, Level level, std::string_view message, std::span<const Field> fields);
  /// Those after the one of that number, oldest first.
  std::vector<Record> after(std::uint64_t seq) const;
  /// The number of the last that was kept; 0: none yet.
  std::uint64_t last() const;

 private:
  void drop_the_oldest();

  mutable std::mutex mutex_;
  std::deque<Record> records_;  // in the order of their numbers, without a gap
  std::size_t bytes_ = 0;
  std::uint64_t last_ = 0;
};

}  // namespace adit::host
