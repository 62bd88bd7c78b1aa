#include "forward/ledger_upkeep.hpp"

#include <memory>
#include <utility>

#include "host/log.hpp"

namespace adit::forward {

void LedgerUpkeep::tick(loop::Writer& disk) {
  if (loop_.now() < at_) return;
  auto work = ledger_.upkeep();
  if (!work) return;
  at_ = loop_.now() + kEvery;  // in case of failure
  const auto result =
      std::make_shared<ledger::Result<void>>(std::unexpected(ledger::Error{.what = "an exception"}));
  disk.submit([work = std::move(work), result] { *result = work(); }, [this, result] { done(*result); });
}

void LedgerUpkeep::done(const ledger::Result<void>& result) {
  ledger_.upkeep_done(result);
  if (result) at_ = loop_.now();
  const std::string why = result ? "" : result.error().what;
  if (std::exchange(trouble_, why) != why && !result)
    host::log(host::Level::Warning, "the ledger has no room in reserve", {{"why", why}});
}

}  // namespace adit::forward
