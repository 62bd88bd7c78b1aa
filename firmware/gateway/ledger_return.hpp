#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>

#include "loop/loop.hpp"
#include "loop/workers.hpp"

namespace adit::gateway {

/// Where the ledger's folder takes no write: looks after each `rest`, and says once that it does
/// again.
class LedgerReturn {
 public:
  static constexpr std::chrono::seconds kRest{5}, kLongestRest{300};

  /// `loop` and `writer`, which waits for the disk, outlive this.
  LedgerReturn(loop::Loop& loop, loop::Writer& writer, std::string folder, std::chrono::seconds rest,
               std::function<void()> is_back);

 private:
  void look();
  void looked(bool can_be_opened);

  loop::Loop& loop_;
  loop::Writer& writer_;
  const std::string folder_;
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
