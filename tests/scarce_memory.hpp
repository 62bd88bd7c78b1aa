#pragma once

#include <cstddef>
#include <limits>

namespace adit {

/// While this lives, memory runs out on this thread: of the allocations with `new` those from number `first`
/// (0: the next one) on throw std::bad_alloc, `count` of them. Of one such at a time.
class ScarceMemory {
 public:
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

  ScarceMemory(std::size_t first, std::size_t count);
  ~ScarceMemory() { end(); }
  ScarceMemory(const ScarceMemory&) = delete;
  ScarceMemory& operator=(const ScarceMemory&) = delete;

  /// There is memory again. How many allocations failed.
  std::size_t end();
  static std::size_t failed();
};

}  // namespace adit
