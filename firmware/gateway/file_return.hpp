#pragma once

#include <algorithm>
#include <chrono>
#include <functional>

#include "loop/loop.hpp"
#include "loop/workers.hpp"

namespace adit::gateway {

/// While the ledger, the settings, a message or another saved file cannot be read: tries after each `rest`,
/// and says once that all can.
class FileReturn {
 public:
  static constexpr std::chrono::seconds kRest{5}, kLongestRest{300};

  /// `writer` calls `can_be_read`, which waits for the disk. `loop` and `writer` outlive this.
  FileReturn(loop::Loop& loop, loop::Writer& writer, std::function<bool()> can_be_read,
             std::chrono::seconds rest, std::function<void()> is_back);

 private:
  void look();

  loop::Loop& loop_;
  loop::Writer& writer_;
  const std::function<bool()> can_be_read_;
  const std::chrono::seconds rest_;
  const std::function<void()> is_back_;
  loop::Source timer_;
};

/// How long the next one rests, if files that seemed to be back were not: a gateway that restarts turns
/// clients away.
inline std::chrono::seconds longer(std::chrono::seconds rest) {
  return std::min(2 * rest, FileReturn::kLongestRest);
}

}  // namespace adit::gateway
