#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

namespace adit::forward {

/// How fast bytes leave, over the last seconds.
class Meter {
 public:
  static constexpr std::size_t kSeconds = 5;

  /// To be called once a second with the number of bytes that have left in all.
  void second(std::uint64_t bytes);
  double mbit() const;

 private:
  std::deque<std::uint64_t> bytes_;  // in all, at each of the last seconds
};

}  // namespace adit::forward
