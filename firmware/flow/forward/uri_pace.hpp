#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <random>

#include "icd/mapping.hpp"
#include "icd/uri.hpp"
#include "journal/journal.hpp"
#include "pace/rate_limit.hpp"
#include "settings/settings.hpp"
#include "uplink/exchange.hpp"

namespace adit::forward {

/// When a URI's next request may go, and with which stamp: its rate limit and its last stamp, which the
/// journal keeps, and its back-off.
class UriPace {
 public:
  /// The Retry-After of a 503, or 0. It is obeyed as long as that of a 429.
  static pace::Duration pause_of(const uplink::Outcome& outcome) {
    const auto* answered = std::get_if<uplink::Answered>(&outcome);
    if (answered == nullptr || answered->status != 503 || !answered->retry_after) return {};
    return std::min(*answered->retry_after, pace::RateLimit::kLongestPause);
  }

  UriPace(icd::Uri uri, double hertz, std::mt19937_64& random, journal::Journal& journal)
      : uri_(uri),
        journal_(journal),
        rate_(hertz),
        backoff_(std::chrono::milliseconds(500), std::chrono::milliseconds(4000)),
        random_(random) {}

  /// For a request that leaves whole.
  pace::Instant ready() const { return std::max(rate_.next(), retry_at_); }
  /// For a request whose last byte may be held back.
  pace::Span earliest() const {
    const pace::Span earliest = rate_.earliest();
    return {.first = std::max(earliest.first, retry_at_), .last = std::max(earliest.last, retry_at_)};
  }

  /// pace::RateLimit::can_pipeline(), and no back-off.
  bool can_pipeline(pace::Instant now) const { return rate_.can_pipeline() && now >= retry_at_; }

  pace::Duration spacing() const { return rate_.spacing(); }

  void restore(const journal::HandoverState& carried, pace::Instant now) {
    const auto learned = carried.paces().find(uri_);
    if (learned != carried.paces().end()) rate_.restore(learned->second, now);
    const auto last = carried.stamps().find(uri_);
    if (last != carried.stamps().end()) last_stamp_ = std::max(last_stamp_, last->second);
  }

  /// Not before the next request of `other`.
  void wait_for(const UriPace& other) { retry_at_ = std::max(retry_at_, other.ready()); }

  void allow(double hertz, pace::Instant now) { rate_.allow(hertz, now); }

  /// pace::RateLimit::claim(), for the operator's test.
  std::optional<pace::Instant> claim(pace::Instant now, pace::Instant latest) {
    const auto at = rate_.claim(now, latest);
    keep();
    return at;
  }
  void on_claimed(pace::Instant now) {
    rate_.on_claimed(now);
    keep();
  }

  /// `stamp`, or a later last stamp (promise 5). Call keep_stamp() with the message's last stamp.
  icd::Stamp next_stamp(icd::Stamp stamp) { return last_stamp_ = std::max(last_stamp_, stamp); }
  void keep_stamp(icd::Stamp last) { journal_.record_stamp(uri_, last); }

  /// Call before it leaves, so that the journal has it if the process ends.
  void on_sent(pace::Instant now, bool ahead = false) {
    rate_.on_sent(now, ahead);
    keep();
  }
  /// The last request has arrived, and is not answered yet.
  void on_departed(const uplink::SendTimes& sent) {
    rate_.on_departed({.first = sent.first, .last = sent.last});
  }
  void on_answered(const uplink::SendTimes& sent, pace::Instant now) {
    rate_.on_answered({.first = sent.first, .last = sent.last}, now);
    keep();
    backoff_.on_succeeded();
  }
  void on_throttled(pace::Instant now, std::optional<std::chrono::seconds> retry_after) {
    rate_.on_throttled(now, retry_after);
    keep();
  }
  /// The spacing begins now.
  void count_from(pace::Instant now) {
    rate_.on_lost(now);
    keep();
  }
  /// It failed, but may have arrived. The record of on_sent() makes the next process wait as long.
  void on_lost(pace::Instant now) {
    rate_.on_lost(now);
    on_failed(now);
  }
  void on_failed(const uplink::Outcome& outcome, pace::Instant now) {
    if (std::holds_alternative<uplink::NeverSent>(outcome)) {
      rate_.on_not_sent();
      on_failed(now);
    } else {
      on_lost(now);
      retry_at_ = std::max(retry_at_, now + pause_of(outcome));
    }
  }
  /// The next request could not be sent.
  void on_failed(pace::Instant now) {
    retry_at_ = now + backoff_.on_failed(std::uniform_real_distribution<double>(0, 1)(random_));
  }

  /// The next failure counts as the first one, because its message differs from the failed ones.
  void forget_failures() { backoff_.on_succeeded(); }

  /// The cable is in again: no wait.
  void on_link_up() {
    backoff_.on_succeeded();
    retry_at_ = {};
  }

 private:
  void keep() { journal_.record_pace(uri_, rate_.learned_rate()); }

  icd::Uri uri_;
  journal::Journal& journal_;
  pace::RateLimit rate_;
  icd::Stamp last_stamp_ = 0;
  pace::Backoff backoff_;
  pace::Instant retry_at_{};
  std::mt19937_64& random_;
};

/// When the next report and the next status may go. Each has its pace, until a 429 shows one limit over both
/// (ICD 5); then they share the reports' pace until the endpoint changes. That 429 does not slow the pace.
class ScoringPace {
 public:
  /// `random` and `journal` outlive this.
  ScoringPace(const settings::Rates& rates, std::mt19937_64& random, journal::Journal& journal);

  void restore(const journal::HandoverState& carried, pace::Instant now);
  void allow(const settings::Rates& rates, pace::Instant now);
  void on_link_up();
  void assume_just_sent(pace::Instant now);
  /// The new Command Post may have two limits.
  void on_new_command_post();

  bool has_one_limit() const { return has_one_limit_; }
  /// For the operator's test, which requests the status itself.
  UriPace& status_pace() { return statuses_; }
  /// Between reports; with one limit, between requests.
  pace::Duration spacing() const { return reports_.spacing(); }
  pace::Instant report_ready() const { return reports_.ready(); }
  /// A status keeps the distance of a report after the last one, unless it `decides` a doubt.
  pace::Instant status_ready(bool decides) const;

  /// Call before the report leaves.
  void on_report_sent(pace::Instant now);
  void on_report_accepted(const uplink::SendTimes& sent, pace::Instant now);
  void on_report_throttled(const uplink::SendTimes& sent, std::optional<std::chrono::seconds> retry_after,
                           pace::Instant now);
  /// The answer rejects all reports for now.
  void on_report_barred(const uplink::SendTimes& sent, pace::Instant now);
  /// It did not leave, or the ledger failed.
  void on_report_failed(pace::Instant now) { reports_.on_failed(now); }
  void on_report_lost(pace::Instant now);

  /// Call before the status leaves.
  void on_status_sent(pace::Instant now);
  void on_status_accepted(const uplink::SendTimes& sent, pace::Instant now);
  void on_status_throttled(const uplink::SendTimes& sent, std::optional<std::chrono::seconds> retry_after,
                           pace::Instant now);
  void on_status_failed(const uplink::Outcome& outcome, pace::Instant now);
  void on_status_lost(pace::Instant now);

 private:
  struct LastRequest {
    pace::Instant left = pace::Instant::min();
    bool is_throttled = false;
  };

  /// `left`: when the request left. `other`: of the other kind. If it was throttled, this 429 does not show
  /// one limit.
  void on_throttled(UriPace& its, pace::Instant left, const LastRequest& other,
                    std::optional<std::chrono::seconds> retry_after, pace::Instant now);

  UriPace reports_, statuses_;
  LastRequest last_report_, last_status_;
  bool has_one_limit_ = false;  // over reports and statuses
};

}  // namespace adit::forward
