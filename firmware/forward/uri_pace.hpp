#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <random>

#include "icd/uri.hpp"
#include "journal/journal.hpp"
#include "pace/backoff.hpp"
#include "pace/rate_limit.hpp"
#include "uplink/connection.hpp"

namespace adit::forward {

/// When the next request to one URI may go: its rate limit, which the journal keeps for the next life, and
/// its back-off after failures.
class UriPace {
 public:
  UriPace(icd::Uri uri, double hertz, std::mt19937_64& random, journal::Journal& journal)
      : uri_(uri),
        journal_(journal),
        rate_(hertz),
        backoff_(std::chrono::milliseconds(500), std::chrono::milliseconds(4000)),
        random_(random) {}

  /// For a request that leaves at once, whole.
  pace::Instant ready() const { return std::max(rate_.next(), retry_at_); }
  /// For one whose last byte may be held back.
  pace::Span earliest() const {
    const pace::Span earliest = rate_.earliest();
    return {.first = std::max(earliest.first, retry_at_), .last = std::max(earliest.last, retry_at_)};
  }

  /// pace::RateLimit::may_go_ahead(), where nothing failed just now.
  bool may_go_ahead(pace::Instant now) const { return rate_.may_go_ahead() && now >= retry_at_; }

  /// Between two requests.
  pace::Duration spacing() const { return rate_.spacing(); }

  void carry_on(const journal::Carried& carried, pace::Instant now) {
    const auto learned = carried.paces().find(uri_);
    if (learned != carried.paces().end()) rate_.carry_on(learned->second, now);
  }

  /// The next request goes no sooner than that of `other` may.
  void wait_for(const UriPace& other) { retry_at_ = std::max(retry_at_, other.ready()); }

  /// The rate that is allowed from now on.
  void allow(double hertz, pace::Instant now) { rate_.allow(hertz, now); }

  /// pace::RateLimit::claim(), for a question of the operator's.
  std::optional<pace::Instant> claim(pace::Instant now, pace::Instant latest) {
    const auto at = rate_.claim(now, latest);
    keep();
    return at;
  }
  void claimed(pace::Instant now) {
    rate_.claimed(now);
    keep();
  }

  /// To be called before it leaves, so that the journal has it even if the program ends in between.
  void sent(pace::Instant now, bool ahead = false) {
    rate_.sent(now, ahead);
    keep();
  }
  /// The one sent last has arrived, and is still to be answered.
  void left(const uplink::Sent& sent) { rate_.left({.first = sent.first, .last = sent.last}); }
  /// `sent`: when its bytes left.
  void taken(const uplink::Sent& sent, pace::Instant now) {
    rate_.taken({.first = sent.first, .last = sent.last}, now);
    keep();
    backoff_.succeeded();
  }
  void throttled(pace::Instant now, std::optional<std::chrono::seconds> retry_after) {
    rate_.throttled(now, retry_after);
    keep();
  }
  /// The spacing to the next request begins now.
  void count_from(pace::Instant now) {
    rate_.lost(now);
    keep();
  }
  /// It failed, but may have been heard. The journal need not be told: what sent() wrote makes the next
  /// process wait as long.
  void lost(pace::Instant now) {
    rate_.lost(now);
    failed(now);
  }
  void failed(const uplink::Outcome& outcome, pace::Instant now) {
    if (!std::holds_alternative<uplink::NeverSent>(outcome)) return lost(now);
    rate_.not_sent();
    failed(now);
  }
  /// The next one could not be sent.
  void failed(pace::Instant now) {
    retry_at_ = now + backoff_.failed(std::uniform_real_distribution<double>(0, 1)(random_));
  }

  /// The cable is in again: the next try need not wait.
  void link_is_back() {
    backoff_.succeeded();
    retry_at_ = {};
  }

 private:
  void keep() { journal_.paced(uri_, rate_.learned()); }

  icd::Uri uri_;
  journal::Journal& journal_;
  pace::RateLimit rate_;
  pace::Backoff backoff_;
  pace::Instant retry_at_{};
  std::mt19937_64& random_;
};

}  // namespace adit::forward
