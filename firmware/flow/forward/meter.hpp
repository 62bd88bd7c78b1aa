#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

namespace adit::forward {

/// Sending rate of the last seconds.
class Meter {
 public:
  static constexpr std::size_t kSeconds = 5;

  /// Call once a second with the total of sent bytes.
  void second(std::uint64_t bytes) {
    bytes_.push_back(bytes);
    if (bytes_.size() > kSeconds + 1) bytes_.pop_front();
  }
  double mbit() const {
    if (bytes_.size() < 2) return 0;
    const auto bytes = static_cast<double>(bytes_.back() - bytes_.front());
    return bytes * 8 / 1e6 / static_cast<double>(bytes_.size() - 1);
  }

 private:
  std::deque<std::uint64_t> bytes_;  // totals of the last seconds
};

}  // namespace adit::forward
