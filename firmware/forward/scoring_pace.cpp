#include "forward/scoring_pace.hpp"

#include <algorithm>

namespace adit::forward {

ScoringPace::ScoringPace(const settings::Rates& rates, std::mt19937_64& random, journal::Journal& journal)
    : reports_(icd::Uri::ArtifactReports, rates.reports_hz, random, journal),
      statuses_(icd::Uri::Status, rates.status_hz, random, journal) {}

void ScoringPace::carry_on(const journal::Carried& carried, pace::Instant now) {
  reports_.carry_on(carried, now);
  statuses_.carry_on(carried, now);
}

void ScoringPace::allow(const settings::Rates& rates, pace::Instant now) {
  reports_.allow(rates.reports_hz, now);
  statuses_.allow(rates.status_hz, now);
}

void ScoringPace::link_is_back() {
  reports_.link_is_back();
  statuses_.link_is_back();
}

void ScoringPace::hold_back(pace::Instant now) {
  reports_.sent(now);
  statuses_.sent(now);
}

void ScoringPace::endpoint_turned() {
  link_is_back();
  has_one_limit_ = false;
}

pace::Instant ScoringPace::status_ready(bool decides) const {
  if (has_one_limit_) return reports_.ready();
  if (decides) return statuses_.ready();
  return std::max(statuses_.ready(), report_left_ + reports_.spacing());
}

void ScoringPace::report_sent(pace::Instant now) {
  report_left_ = now;
  reports_.sent(now);
}

void ScoringPace::report_taken(const uplink::Sent& sent, pace::Instant now) {
  report_left_ = sent.first;
  reports_.taken(sent, now);
}

void ScoringPace::report_throttled(const uplink::Sent& sent, std::optional<std::chrono::seconds> retry_after,
                                   pace::Instant now) {
  report_left_ = sent.first;
  throttled(reports_, report_left_, status_left_, retry_after, now);
}

void ScoringPace::report_barred(const uplink::Sent& sent, pace::Instant now) {
  report_left_ = sent.first;
  reports_.lost(now);
}

void ScoringPace::report_lost(pace::Instant now) {
  report_left_ = now;
  reports_.taken({.first = now, .last = now}, now);
}

void ScoringPace::status_sent(pace::Instant now) {
  status_left_ = now;
  of_status().sent(now);
  if (has_one_limit_) statuses_.count_from(now);  // for the next endpoint
}

void ScoringPace::status_taken(const uplink::Sent& sent, pace::Instant now) {
  status_left_ = sent.first;
  of_status().taken(sent, now);
}

void ScoringPace::status_throttled(const uplink::Sent& sent, std::optional<std::chrono::seconds> retry_after,
                                   pace::Instant now) {
  status_left_ = sent.first;
  throttled(of_status(), status_left_, report_left_, retry_after, now);
}

void ScoringPace::throttled(UriPace& its, pace::Instant left, pace::Instant other_left,
                            std::optional<std::chrono::seconds> retry_after, pace::Instant now) {
  const bool is_found_out = !has_one_limit_ && left < other_left + reports_.spacing();
  has_one_limit_ = has_one_limit_ || is_found_out;
  if (!is_found_out || retry_after) its.throttled(now, retry_after);
  if (is_found_out) reports_.count_from(now);
}

}  // namespace adit::forward
