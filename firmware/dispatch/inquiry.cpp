#include "dispatch/inquiry.hpp"

namespace adit::dispatch {

Finding Inquiry::hear(const Evidence& evidence, double run_clock, Instant asked, Instant now) {
  Finding finding = evidence.finding;
  if (finding == Finding::NotRecorded && stands_still(run_clock, now)) finding = Finding::Silent;
  if (!first_heard_) {
    first_heard_ = now;
    first_clock_ = run_clock;
  }
  last_heard_ = now;
  agreeing_ = finding == finding_ ? agreeing_ + 1 : 1;
  finding_ = finding;
  in_vain_ = !is_pending(now);
  if (finding == Finding::Recorded && agreeing_ < kRecordedAsks) return Finding::Silent;
  const bool late_enough = asked - lost_ >= patience_.doubt_for && agreeing_ >= patience_.asks;
  if (finding == Finding::NotRecorded && !late_enough) return Finding::Silent;
  return finding;
}

/// In an administrative stop (ICD 5.2) the clock stands, and the counts do not show reports.
bool Inquiry::stands_still(double run_clock, Instant now) const {
  if (!first_heard_) return false;
  constexpr std::chrono::duration<double> kTooShort{0.2};  // two answers may take unequal times
  constexpr double kRuns = 0.25;  // a running clock shows at least this part of the elapsed time
  const std::chrono::duration<double> elapsed = now - *first_heard_;
  return elapsed > kTooShort && run_clock - first_clock_ < elapsed.count() * kRuns;
}

Inquiry::Instant Inquiry::next_ask(Instant now) const {
  if (!asked_) return now;
  return *asked_ + (is_pending(now) ? patience_.doubt_for / 10 : patience_.doubt_for);
}

bool Inquiry::is_pending(Instant now) const {
  if (now < lost_ + patience_.doubt_for * 3 / 2) return true;
  const bool speaks = finding_ == Finding::Recorded || finding_ == Finding::NotRecorded;
  return speaks && now < *last_heard_ + patience_.doubt_for / 2;
}

}  // namespace adit::dispatch
