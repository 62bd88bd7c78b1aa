#pragma once

#include <chrono>
#include <optional>
#include <random>

#include "forward/uri_pace.hpp"
#include "settings/settings.hpp"

namespace adit::forward {

/// When the next report and the next status may go to the scoring endpoint. Reports and statuses have a pace
/// each until a 429 shows that the Command Post has one limit over both (ICD 5): then both share the pace of
/// reports until the endpoint changes. That 429 teaches no slower pace.
class ScoringPace {
 public:
  /// `random` and `journal` outlive this.
  ScoringPace(const settings::Rates& rates, std::mt19937_64& random, journal::Journal& journal);

  void carry_on(const journal::Carried& carried, pace::Instant now);
  /// The rates of the settings.
  void allow(const settings::Rates& rates, pace::Instant now);
  void link_is_back();
  /// As if a report and a status had just been sent.
  void hold_back(pace::Instant now);
  /// The next Command Post may have two limits.
  void endpoint_turned();

  bool has_one_limit() const { return has_one_limit_; }
  /// For the operator's test, which asks for the status by itself.
  UriPace& of_status() { return statuses_; }
  /// Between two reports; of one limit, between two requests.
  pace::Duration spacing() const { return reports_.spacing(); }
  pace::Instant report_ready() const { return reports_.ready(); }
  /// A status keeps away from the last report as another report would, unless it `decides` what became of
  /// one.
  pace::Instant status_ready(bool decides) const;

  /// To be called before the report leaves.
  void report_sent(pace::Instant now);
  void report_taken(const uplink::Sent& sent, pace::Instant now);
  void report_throttled(const uplink::Sent& sent, std::optional<std::chrono::seconds> retry_after,
                        pace::Instant now);
  /// The answer says that no report is taken now.
  void report_barred(const uplink::Sent& sent, pace::Instant now);
  /// It did not leave, or was not sent because the ledger could not be written.
  void report_failed(pace::Instant now) { reports_.failed(now); }
  void report_lost(pace::Instant now);

  /// To be called before the status leaves.
  void status_sent(pace::Instant now);
  void status_taken(const uplink::Sent& sent, pace::Instant now);
  void status_throttled(const uplink::Sent& sent, std::optional<std::chrono::seconds> retry_after,
                        pace::Instant now);
  void status_failed(const uplink::Outcome& outcome, pace::Instant now);
  void status_lost(pace::Instant now);

 private:
  /// The last request of one kind.
  struct Last {
    pace::Instant left = pace::Instant::min();
    bool is_throttled = false;
  };

  /// A 429 to a request that left at `left`. `other`: of the other kind. If that was throttled, all may be,
  /// and the 429 shows no limit over both.
  void throttled(UriPace& its, pace::Instant left, const Last& other,
                 std::optional<std::chrono::seconds> retry_after, pace::Instant now);

  UriPace reports_, statuses_;
  Last last_report_, last_status_;
  bool has_one_limit_ = false;  // the Command Post, over reports and statuses
};

}  // namespace adit::forward
