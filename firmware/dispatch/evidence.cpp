#include "dispatch/evidence.hpp"

#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

/// "remaining_reports went from 20 to 18 and the score from 3 to 4, with 2 reports in doubt"
std::string figures(const icd::RunStatus& before, std::int64_t doubts, const SentSince& since,
                    const icd::RunStatus& now) {
  std::string text =
      icd::sentence("remaining_reports went from ", before.remaining_reports, " to ", now.remaining_reports,
                    " and the score from ", before.score, " to ", now.score);
  if (since.scored > 0) text += icd::sentence(", ", since.scored, " of it by reports sent since");
  if (doubts > 1) text += icd::sentence(", with ", doubts, " reports in doubt");
  return text;
}

}  // namespace

Evidence weigh(const icd::RunStatus& before, std::int64_t doubts, const SentSince& since,
               const icd::RunStatus& now) {
  const std::int64_t used = before.remaining_reports - since.scored - now.remaining_reports;
  const std::int64_t points = now.score - before.score - since.points;
  const std::string seen = figures(before, doubts, since, now);
  if (before.run_clock <= 0 && (used != 0 || points != 0)) {
    return {Finding::Silent,
            seen + ": before a run starts, the Command Post may set its counts to any value",
            {}};
  }
  if (used < 0 || used > doubts || points < 0 || points > used) {
    return {Finding::Contradicts, seen + ": does another sender report with this token?", {}};
  }
  // Then the counts do not show a record.
  if (used == 0 && (before.remaining_reports - since.scored <= 0 || now.run_clock <= 0)) {
    return {Finding::Silent,
            seen + ": reports are not scored now, so that the counts do not show a recorded report",
            {}};
  }
  if (used == 0) return {Finding::NotRecorded, seen, {}};
  if (used < doubts)
    return {Finding::Silent, seen + ": the counts do not show which of them was recorded", {}};
  const bool alike = points == 0 || points == doubts;
  return {Finding::Recorded, seen, alike ? std::optional(points / doubts) : std::nullopt};
}

}  // namespace adit::dispatch
