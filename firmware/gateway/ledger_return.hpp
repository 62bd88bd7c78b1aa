#pragma once

#include <algorithm>
#include <chrono>
#include <functional>

#include "loop/loop.hpp"
#include "loop/workers.hpp"

namespace adit::gateway {

/// While the ledger cannot be written to, or a saved file cannot be read: looks after each `rest`, and says
/// once that it can.
class LedgerReturn {
 public:
  static constexpr std::chrono::seconds kRest{5}, kLongestRest{300};

  /// `writer` calls `can_be_opened`, which waits for the disk. `loop` and `writer` outlive this.
  LedgerReturn(loop::Loop& loop, loop::Writer& writer, std::function<bool()> can_be_opened,
               std::chrono::seconds rest, std::function<void()> is_back);

 private:
  void look();
  void looked(bool can_be_opened);

  loop::Loop& loop_;
  loop::Writer& writer_;
  const std::function<bool()> can_be_opened_;
  const std::chrono::seconds rest_;
  const std::function<void()> is_back_;
  loop::Source timer_;
};

/// How long the next one rests, where a ledger that seemed to be back was not: a gateway that restarts
/// turns clients away.
inline std::chrono::seconds longer(std::chrono::seconds rest) {
  return std::min(2 * rest, LedgerReturn::kLongestRest);
}

}  // namespace adit::gateway
