#include "dispatch/inquiry.hpp"

#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

/// "remaining_reports went from 20 to 18 and the score from 3 to 4, with 2 reports in doubt"
std::string figures(const icd::RunStatus& before, std::int64_t doubts, std::int64_t beside,
                    const SentSince& since, const icd::RunStatus& now) {
  std::string text =
      icd::sentence("remaining_reports went from ", before.remaining_reports, " to ", now.remaining_reports,
                    " and the score from ", before.score, " to ", now.score);
  if (since.scored > 0) text += icd::sentence(", ", since.scored, " of it by reports sent since");
  if (doubts > 1) text += icd::sentence(", with ", doubts, " reports in doubt");
  if (beside > 0) {
    text += icd::sentence("; ", beside, beside > 1 ? " other reports" : " other report",
                          " in doubt may explain it");
  }
  return text;
}

}  // namespace

Evidence weigh(const icd::RunStatus& before, std::int64_t doubts, std::int64_t beside, const SentSince& since,
               const icd::RunStatus& now) {
  const std::int64_t all = doubts + beside;
  const std::int64_t used = before.remaining_reports - since.scored - now.remaining_reports;
  const std::int64_t points = now.score - before.score - since.points;
  const std::string seen = figures(before, doubts, used > 0 ? beside : 0, since, now);
  if (before.run_clock <= 0 && (used != 0 || points != 0)) {
    return {Finding::Silent,
            seen + ": before a run starts, the Command Post may set its counts to any value",
            {}};
  }
  if (used < 0 || used > all || points < 0 || points > used + since.unclear) {
    const bool is_corrected = used < 0 || points < 0;  // no report does that
    return {Finding::Contradicts,
            seen + (is_corrected ? ": were the counts corrected?"
                                 : ": does another sender report with this token?"),
            {}};
  }
  // Then the counts do not show a record.
  if (used == 0 && (before.remaining_reports - since.scored <= 0 || now.run_clock <= 0)) {
    return {Finding::Silent,
            seen + ": reports are not scored now, so that the counts do not show a recorded report",
            {}};
  }
  if (used == 0) return {Finding::NotRecorded, seen, {}};
  if (used < all) return {Finding::Silent, seen + ": the counts do not show which of them was recorded", {}};
  const bool alike = points == 0 || points == all + since.unclear;
  return {Finding::Recorded, seen, alike ? std::optional<std::int64_t>(points > 0 ? 1 : 0) : std::nullopt};
}

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
  const bool late_enough = asked - lost_ >= policy_.doubt_for && agreeing_ >= policy_.asks;
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

Instant Inquiry::next_ask(Instant now) const {
  if (!asked_) return now;
  return *asked_ + (in_vain_ ? policy_.doubt_for : policy_.doubt_for / 10);
}

bool Inquiry::is_pending(Instant now) const {
  if (now < lost_ + policy_.doubt_for * 3 / 2) return true;
  const bool speaks = finding_ == Finding::Recorded || finding_ == Finding::NotRecorded;
  return speaks && now < *last_heard_ + policy_.doubt_for / 2;
}

}  // namespace adit::dispatch
