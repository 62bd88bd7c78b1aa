#pragma once

#include <optional>
#include <string>

#include "dispatch/report.hpp"

namespace adit::dispatch {

/// Effect of Adit's reports after the first one in doubt.
struct SentSince {
  std::int64_t scored = 0;   // remaining reports that they used up
  std::int64_t points = 0;   // points that they gained, if certain
  std::int64_t unclear = 0;  // reports that may have gained one more
};

/// What the run's status shows about all reports in doubt.
enum class Finding : std::uint8_t {
  Recorded,
  NotRecorded,
  Silent,       // the status does not show it; a later one may
  Contradicts,  // Adit's own reports do not explain the counts, so the counts prove no report in this run
};

struct Evidence {
  Finding finding = Finding::Silent;
  std::string why;  // a sentence with the figures
  /// Points of each report, if certain.
  std::optional<std::int64_t> points_each;
};

/// Compares the present status with the status expected before the first of `doubts` reports was sent. A
/// recorded report lowers remaining_reports by one (ICD 5.1) and gains 0 or 1 point (ICD 5.2). `beside`:
/// other reports in doubt that may have changed the counts since.
Evidence weigh(const icd::RunStatus& before, std::int64_t doubts, std::int64_t beside, const SentSince& since,
               const icd::RunStatus& now);

struct InquiryPolicy {
  /// From the loss to a request whose status may say "not recorded". The Command Post may record a report so
  /// late.
  std::chrono::milliseconds doubt_for{10000};
  std::int64_t asks = 3;  // successive statuses that must say "not recorded"
};

/// Decides from repeated statuses whether the reports in doubt were recorded.
class Inquiry {
 public:
  static constexpr std::int64_t kRecordedAsks = 2;  // successive statuses that must say "recorded"

  Inquiry(const InquiryPolicy& policy, Instant lost) : policy_(policy), lost_(lost) {}

  /// Adds the evidence of a status that was requested at `asked`. Returns the certain result, else Silent.
  Finding hear(const Evidence& evidence, double run_clock, Instant asked, Instant now);
  void asked(Instant now) { asked_ = now; }
  void failed(Instant now) { in_vain_ = !is_pending(now); }
  /// No result for too long. Adit goes on asking, and the operator may decide.
  bool is_in_vain() const { return in_vain_; }

  Instant next_ask(Instant now) const;
  /// Other reports must wait. A second lost report would make the counts ambiguous.
  bool is_pending(Instant now) const;

 private:
  bool stands_still(double run_clock, Instant now) const;

  InquiryPolicy policy_;
  Instant lost_;
  std::optional<Instant> asked_;
  Finding finding_ = Finding::Silent;
  std::int64_t agreeing_ = 0;
  std::optional<Instant> first_heard_, last_heard_;
  double first_clock_ = 0;
  bool in_vain_ = false;
};

}  // namespace adit::dispatch
