#pragma once

#include <chrono>
#include <string>

#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"

namespace adit::forward {

/// Lets the ledger prepare room in the background.
class LedgerUpkeep {
 public:
  /// Delay after a start or a failure. The first messages have priority.
  static constexpr std::chrono::seconds kEvery{60};

  /// Both outlive this.
  LedgerUpkeep(loop::Loop& loop, ledger::Ledger& ledger) : loop_(loop), ledger_(ledger) {}

  /// Call once a second. `disk` does the work. A failure is logged once.
  void tick(loop::Writer& disk);

 private:
  void done(const ledger::Result<void>& result);

  loop::Loop& loop_;
  ledger::Ledger& ledger_;
  loop::Instant at_ = loop_.now() + kEvery;
  std::string trouble_;  // why it failed, or ""
};

}  // namespace adit::forward
