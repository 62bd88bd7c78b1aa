#include "forward/stamp_floor.hpp"

#include <string_view>
#include <utility>

#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/try.hpp"
#include "store/frame.hpp"

namespace adit::forward {
namespace {

constexpr std::uint8_t kKind = 1;
constexpr std::uint64_t kSalt = 0;  // no part of the file comes from a peer

/// The content of the copy at `offset`, or std::nullopt if the copy is damaged.
std::optional<StampFloor::Kept> copy_at(std::string_view file, std::size_t offset) {
  const auto parsed = store::parse(file, offset, kSalt);
  if (!parsed || parsed->frame.kind != kKind) return std::nullopt;
  store::Reader take(parsed->frame.body);  // a later version may add members
  const auto kept = take.read<StampFloor::Kept>();
  return take.ok() ? std::optional(kept) : std::nullopt;
}

}  // namespace

std::expected<StampFloor::Kept, std::string> StampFloor::read() const {
  if (!host::may_exist(file_)) return Kept{};
  const auto text = ADIT_TRY(host::read_file(file_));
  const auto one = copy_at(text, 0), other = copy_at(text, store::kOnDisk.align);
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
  const std::string body = store::bytes_of(kept);
  const std::string file = store::written({.kind = kKind, .body = body}, store::kOnDisk, kSalt, 0);
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
