#include "forward/stamp_floor.hpp"

#include <utility>

#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/try.hpp"
#include "store/frame.hpp"

namespace adit::forward {

std::expected<StampFloor::Kept, std::string> StampFloor::read() const {
  if (!host::may_exist(file_)) return Kept{};
  const auto text = ADIT_TRY(host::read_file(file_));
  const auto one = store::value_in<Kept>(text), other = store::value_in<Kept>(text, store::kOnDisk.align);
  if (!one || !other)
    host::log(host::Level::Warning, "a copy of the last time stamps is damaged",
              {{"file", file_}, {"now", one || other ? "the other copy is used" : "stamps may go back"}});
  const Kept none{.is_damaged = true}, &first = one ? *one : none, &second = other ? *other : none;
  return first.floor < second.floor ? second : first;  // a power cut may have left an older copy
}

std::optional<StampFloor::Kept> StampFloor::due(double now, double wall, const ledger::Known& ledger) {
  const bool is_soon = ledger != ledger_ || outcome_->has_failed;
  if (now < last_ + (is_soon ? kSoon : kEvery)) return {};
  last_ = now;
  ledger_ = ledger;
  return Kept{.floor = now + kAhead, .wall = wall, .ledger = ledger};
}

void StampFloor::write(const Kept& kept) {
  const std::string file = store::file_of(kept, store::kOnDisk);
  auto written = host::write_file(file_, file, host::kOursAlone);
  if (!written && host::write_over(file_, file)) written = {};  // for a full disk
  const std::string why = written ? "" : written.error();
  outcome_->has_failed = !written;
  if (std::exchange(outcome_->trouble, why) == why || written) return;
  host::log(host::Level::Warning,
            "cannot store the last time stamps; after a power cut, time stamps may run backward",
            {{"why", written.error()}});
}

void StampFloor::forget() {
  const auto kept = read();
  if (!kept || kept->lead.value_or(0) <= kMostAhead) return;
  host::log(host::Level::Notice, "the bound of time stamps is forgotten; time stamps step back once");
  write({.ledger = kept->ledger, .overruled = kept->floor});
}

}  // namespace adit::forward
