#include "forward/uri_pace.hpp"

#include <algorithm>

namespace adit::forward {

ScoringPace::ScoringPace(const settings::Rates& rates, std::mt19937_64& random, journal::Journal& journal)
    : reports_(icd::Uri::ArtifactReports, rates.reports_hz, random, journal),
      statuses_(icd::Uri::Status, rates.status_hz, random, journal) {}

void ScoringPace::restore(const journal::HandoverState& carried, pace::Instant now) {
  reports_.restore(carried, now);
  statuses_.restore(carried, now);
}

void ScoringPace::allow(const settings::Rates& rates, pace::Instant now) {
  reports_.allow(rates.reports_hz, now);
  statuses_.allow(rates.status_hz, now);
}

void ScoringPace::on_link_up() {
  reports_.on_link_up();
  statuses_.on_link_up();
}

void ScoringPace::assume_just_sent(pace::Instant now) {
  reports_.on_sent(now);
  statuses_.on_sent(now);
}

void ScoringPace::on_new_command_post() {
  on_link_up();
  has_one_limit_ = false;
}

pace::Instant ScoringPace::status_ready(bool decides) const {
  if (has_one_limit_) return std::max(statuses_.ready(), reports_.ready());
  if (decides) return statuses_.ready();
  return std::max(statuses_.ready(), last_report_.left + reports_.spacing());
}

void ScoringPace::on_report_sent(pace::Instant now) {
  last_report_ = {.left = now};
  reports_.on_sent(now);
}

void ScoringPace::on_report_accepted(const uplink::SendTimes& sent, pace::Instant now) {
  last_report_ = {.left = sent.first};
  reports_.on_answered(sent, now);
}

void ScoringPace::on_report_throttled(const uplink::SendTimes& sent,
                                      std::optional<std::chrono::seconds> retry_after, pace::Instant now) {
  last_report_ = {.left = sent.first, .is_throttled = true};
  on_throttled(reports_, sent.first, last_status_, retry_after, now);
}

void ScoringPace::on_report_barred(const uplink::SendTimes& sent, pace::Instant now) {
  last_report_ = {.left = sent.first};
  reports_.on_lost(now);
}

void ScoringPace::on_report_lost(pace::Instant now) {
  last_report_ = {.left = now};
  reports_.on_answered({.first = now, .last = now}, now);
}

void ScoringPace::on_status_sent(pace::Instant now) {
  last_status_ = {.left = now};
  statuses_.on_sent(now);
  if (has_one_limit_) reports_.on_sent(now);
}

void ScoringPace::on_status_accepted(const uplink::SendTimes& sent, pace::Instant now) {
  last_status_ = {.left = sent.first};
  statuses_.on_answered(sent, now);
  if (has_one_limit_) reports_.on_answered(sent, now);
}

void ScoringPace::on_status_throttled(const uplink::SendTimes& sent,
                                      std::optional<std::chrono::seconds> retry_after, pace::Instant now) {
  last_status_ = {.left = sent.first, .is_throttled = true};
  if (has_one_limit_) reports_.on_throttled(now, retry_after);
  on_throttled(statuses_, sent.first, last_report_, retry_after, now);
}

void ScoringPace::on_status_failed(const uplink::Outcome& outcome, pace::Instant now) {
  statuses_.on_failed(outcome, now);
  if (has_one_limit_) reports_.on_failed(outcome, now);
}

void ScoringPace::on_status_lost(pace::Instant now) {
  statuses_.on_lost(now);
  if (has_one_limit_) reports_.on_lost(now);
}

void ScoringPace::on_throttled(UriPace& its, pace::Instant left, const LastRequest& other,
                               std::optional<std::chrono::seconds> retry_after, pace::Instant now) {
  const bool is_found_out = !has_one_limit_ && !other.is_throttled && left < other.left + reports_.spacing();
  has_one_limit_ = has_one_limit_ || is_found_out;
  if (!is_found_out || retry_after) {
    its.on_throttled(now, retry_after);
  } else {
    its.count_from(now);
  }
  if (is_found_out) reports_.wait_for(statuses_);
}

}  // namespace adit::forward
