#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <span>
#include <vector>

#include "host/log.hpp"

namespace adit::host {

/// The last log records, for users without access to the journal: at most kMost records and kMostBytes of
/// text. The oldest are dropped first. Thread-safe.
class Memory {
 public:
  static constexpr std::size_t kMost = 2000;
  static constexpr std::size_t kMostBytes = 1u << 20;
  static constexpr std::size_t kLongest = 4096;  // bytes of a message or a value; the rest is cut

  /// `at`: seconds since 1970.
  void keep(double at, Level level, std::string_view message, std::span<const Field> fields);
  /// Records with a larger number, oldest first.
  std::vector<Record> after(std::uint64_t seq) const;
  /// Number of the last stored record; 0: no record yet.
  std::uint64_t last() const;

 private:
  void drop_the_oldest();

  mutable std::mutex mutex_;
  std::deque<Record> records_;  // by number, without gaps
  std::size_t bytes_ = 0;
  std::uint64_t last_ = 0;
};

}  // namespace adit::host
