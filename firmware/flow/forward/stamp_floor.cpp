#include "forward/stamp_floor.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::forward {
namespace {

/// Year 2200: later values are no stamps.
constexpr double kLatest = 7.26e9;

/// Of the first line, which is removed; -1: no number.
template <class Number>
Number take(std::string_view& rest) {
  Number number = -1;
  const std::string_view line = icd::cut(rest, '\n');
  std::from_chars(line.data(), line.data() + line.size(), number);
  return number;
}

double take_time(std::string_view& rest) {
  const auto time = take<double>(rest);
  return time >= 0 && time < kLatest ? time : -1;
}

}  // namespace

std::expected<StampFloor::Kept, std::string> StampFloor::read() const {
  if (!host::may_exist(file_)) return Kept{};
  const auto text = ADIT_TRY(host::read_file(file_));
  std::string_view rest = text;
  const double floor = take_time(rest);
  if (floor >= 0) {
    Kept kept{.floor = floor};
    kept.wall = std::max(0.0, take_time(rest));
    kept.least = std::max(0.0, take_time(rest));
    kept.ledger.reports = std::max(std::int64_t{0}, take<std::int64_t>(rest));
    kept.ledger.log = static_cast<std::uint64_t>(std::max(std::int64_t{0}, take<std::int64_t>(rest)));
    return kept;
  }
  host::log(host::Level::Warning, "cannot read the last time stamps used",
            {{"why", file_ + ": expected seconds since 1970"}});
  return Kept{};
}

std::optional<StampFloor::Kept> StampFloor::due(double now, double wall, const ledger::Known& ledger) {
  const bool is_soon = ledger != ledger_ || outcome_->has_failed;
  if (now < last_ + (is_soon ? kSoon : kEvery)) return {};
  last_ = now;
  ledger_ = ledger;
  return Kept{.floor = now + kAhead, .wall = wall, .ledger = ledger};
}

void StampFloor::write(const Kept& kept) {
  std::string text;
  for (const double time : {kept.floor, kept.wall, kept.least}) text += std::to_string(time) + '\n';
  text += std::to_string(kept.ledger.reports) + '\n' + std::to_string(kept.ledger.log) + '\n';
  auto written = host::write_file(file_, text, host::kOursAlone);
  if (!written && host::write_over(file_, text)) written = {};  // for a full disk
  const std::string why = written ? "" : written.error();
  outcome_->has_failed = !written;
  if (std::exchange(outcome_->trouble, why) == why || written) return;
  host::log(host::Level::Warning,
            "cannot store the last time stamps; after a power cut, time stamps may run backward",
            {{"why", written.error()}});
}

}  // namespace adit::forward
