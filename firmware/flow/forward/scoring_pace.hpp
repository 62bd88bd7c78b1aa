#pragma once

#include <chrono>
#include <optional>
#include <random>

#include "forward/uri_pace.hpp"
#include "settings/settings.hpp"

namespace adit::forward {

/// When the next report and the next status may go. Each has its pace, until a 429 shows one limit over both
/// (ICD 5); then they share the reports' pace until the endpoint changes. That 429 does not slow the pace.
class ScoringPace {
 public:
  /// `random` and `journal` outlive this.
  ScoringPace(const settings::Rates& rates, std::mt19937_64& random, journal::Journal& journal);

  void carry_on(const journal::Carried& carried, pace::Instant now);
  /// By the settings.
  void allow(const settings::Rates& rates, pace::Instant now);
  void link_is_back();
  /// As if both had just been sent.
  void hold_back(pace::Instant now);
  /// The new Command Post may have two limits.
  void endpoint_turned();

  bool has_one_limit() const { return has_one_limit_; }
  /// For the operator's test, which requests the status itself.
  UriPace& of_status() { return statuses_; }
  /// Between reports; with one limit, between requests.
  pace::Duration spacing() const { return reports_.spacing(); }
  pace::Instant report_ready() const { return reports_.ready(); }
  /// A status keeps the distance of a report after the last one, unless it `decides` a doubt.
  pace::Instant status_ready(bool decides) const;

  /// Call before the report leaves.
  void report_sent(pace::Instant now);
  void report_taken(const uplink::Sent& sent, pace::Instant now);
  void report_throttled(const uplink::Sent& sent, std::optional<std::chrono::seconds> retry_after,
                        pace::Instant now);
  /// The answer rejects all reports for now.
  void report_barred(const uplink::Sent& sent, pace::Instant now);
  /// It did not leave, or the ledger failed.
  void report_failed(pace::Instant now) { reports_.failed(now); }
  void report_lost(pace::Instant now);

  /// Call before the status leaves.
  void status_sent(pace::Instant now);
  void status_taken(const uplink::Sent& sent, pace::Instant now);
  void status_throttled(const uplink::Sent& sent, std::optional<std::chrono::seconds> retry_after,
                        pace::Instant now);
  void status_failed(const uplink::Outcome& outcome, pace::Instant now);
  void status_lost(pace::Instant now);

 private:
  struct Last {
    pace::Instant left = pace::Instant::min();
    bool is_throttled = false;
  };

  /// `left`: when the request left. `other`: of the other kind. If it was throttled, this 429 does not show
  /// one limit.
  void throttled(UriPace& its, pace::Instant left, const Last& other,
                 std::optional<std::chrono::seconds> retry_after, pace::Instant now);

  UriPace reports_, statuses_;
  Last last_report_, last_status_;
  bool has_one_limit_ = false;  // over reports and statuses
};

}  // namespace adit::forward
