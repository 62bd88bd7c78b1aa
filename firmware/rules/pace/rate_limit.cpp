#include "pace/rate_limit.hpp"

#include <algorithm>
#include <utility>

namespace adit::pace {

std::chrono::nanoseconds Backoff::on_failed(double random) {
  const std::chrono::duration<double, std::milli> wait = std::min(wait_, most_);
  wait_ = wait_ > most_ / 2 ? most_ : wait_ * 2;
  return std::chrono::duration_cast<std::chrono::nanoseconds>(wait * (1 + random / 4));
}

namespace {

using Seconds = std::chrono::duration<double>;

/// Factors for the spacing: a 429 comes at once after a storm; a 429 comes soon; a trial step.
constexpr double kFarOff = 1.5, kSlightlyOff = 1.25, kFaster = 0.67;
/// Factor for a pause that worked once: networks do not keep time to the millisecond.
constexpr double kMargin = 1.05;
/// This part of the spacing is added if the spacing counts from when the first request left.
constexpr int kUneven = 50;
/// This part of the spacing is kept free before and after a claimed request: its connection must be made
/// first, and the two connections do not keep in step.
constexpr int kBeside = 4;
/// This many single 429s are no coincidence.
constexpr int kOfAKind = 2;

/// Between two requests at `hertz`. A very low rate does not overflow.
Duration spacing_at(double hertz) {
  constexpr Seconds kLongest = std::chrono::hours{24};
  return std::chrono::duration_cast<Duration>(std::min(Seconds{1 / hertz}, kLongest));
}

Duration times(Duration duration, double factor) {
  return std::chrono::duration_cast<Duration>(Seconds{duration} * factor);
}

}  // namespace

RateLimit::RateLimit(double hertz) : allowed_(spacing_at(hertz)), rule_{.spacing = allowed_} {}

void RateLimit::allow(double hertz, Instant now) {
  const Duration before = std::exchange(allowed_, spacing_at(hertz));
  if (allowed_ == before) return;
  const bool is_learned = rule_.spacing > before;
  rule_.spacing = is_learned ? std::max(rule_.spacing, allowed_) : allowed_;
  if (tried_from_ && tried_from_->spacing <= allowed_) tried_from_.reset();
  const Instant longest = now + std::max<Duration>(rule_.spacing, kLongestPause);
  floor_ = {.first = std::min(floor_.first, longest), .last = std::min(floor_.last, longest)};
}

Span RateLimit::earliest() const {
  if (!counted_) return floor_;
  return {.first = std::max(floor_.first, counted_->first + rule_.spacing),
          .last = std::max(floor_.last, counted_->last + rule_.spacing)};
}

Instant RateLimit::next() const {
  const Span at = earliest();
  return std::max(at.first, at.last);
}

void RateLimit::on_sent(Instant now, bool ahead) {
  if (storm_ && sent_) storm_->worked = now - *sent_;
  sent_ = now;
  under_way_ = ahead ? 2 : 1;
  count({.first = now, .last = now});
}

/// The later of two requests counts, even if it is answered first.
void RateLimit::count(const Span& sent) {
  const Span before = counted_.value_or(sent);
  counted_ = {.first = std::max(before.first, sent.first), .last = std::max(before.last, sent.last)};
}

Duration RateLimit::spacing() const {
  return rule_.from_answers ? rule_.spacing : rule_.spacing + rule_.spacing / kUneven;
}

void RateLimit::on_departed(const Span& sent) {
  const Duration uneven = rule_.spacing / kUneven;
  count({.first = sent.first + uneven, .last = sent.last + uneven});
}

/// Counts the end of one request in flight. True if it was sent before the present storm.
bool RateLimit::end_request() {
  under_way_ = std::max(under_way_ - 1, 0);
  if (!storm_ || storm_->sent_before == 0) return false;
  --storm_->sent_before;
  return true;
}

void RateLimit::on_answered(const Span& sent, Instant now) {
  const bool sent_before = end_request();
  if (storm_ && !sent_before) {
    if (storm_->counts_anew && storm_->is_one) ++single_;
    if (last_storm_) storm_->on_average = (now - last_storm_->ended) / (taken_since_ + 1);
    storm_->ended = now;
    taken_since_ = 0;
    last_storm_ = std::exchange(storm_, std::nullopt);
  } else {
    ++taken_since_;
    if (!sent_before) speed_up(now);
  }
  if (!sent_before) floor_ = {};
  if (!rule_.from_answers) return on_departed(sent);
  count({.first = now, .last = now});
}

void RateLimit::on_lost(Instant now) {
  end_request();
  count({.first = now, .last = now});
}

void RateLimit::on_throttled(Instant now, std::optional<std::chrono::seconds> retry_after) {
  const bool sent_before = end_request();
  if (!storm_) {
    begin_storm(now);
  } else if (!sent_before) {
    storm_->is_one = false;
    storm_->pause = std::max(allowed_, std::min<Duration>(storm_->pause * 2, kStormPause));
  }
  const auto asked = std::clamp(retry_after.value_or(std::chrono::seconds{0}), {}, kLongestPause);
  const Instant next = now + std::max<Duration>({storm_->pause, rule_.spacing, asked});
  floor_ = {.first = std::max(floor_.first, next), .last = std::max(floor_.last, next)};
}

std::optional<Instant> RateLimit::claim(Instant now, Instant latest) {
  const Instant at = std::max(now, next() + rule_.spacing / kBeside);
  if (at > latest) return std::nullopt;
  on_claimed(at);
  return at;
}

void RateLimit::on_claimed(Instant now) {
  const Instant counted = now + rule_.spacing / kBeside;
  count({.first = counted, .last = counted});
}

void RateLimit::begin_storm(Instant now) {
  const bool counted_from_answers = rule_.from_answers;
  soon_again_ = last_storm_ && now - last_storm_->ended <= kSoonAgain ? soon_again_ + 1 : 0;
  const auto tried_from = std::exchange(tried_from_, std::nullopt);
  if (tried_from && now - learned_at_ <= kSoonAgain) {  // the last step was one too many
    rule_ = *tried_from;
    learned_at_ = now;
    hold_ = std::min<Duration>(hold_ * 2, kLongestHold);
  } else if (!rule_.from_answers) {
    rule_.from_answers = true;
    learned_at_ = now;
  } else if (is_a_limit()) {
    slow_down(now);
  }
  storm_ = Storm{.began = now,
                 .pause = allowed_,
                 .sent_before = under_way_,
                 .counts_anew = rule_.from_answers && !counted_from_answers};
}

bool RateLimit::is_a_limit() const {
  if (soon_again_ == 0) return false;
  const bool was_short = last_storm_->ended - last_storm_->began <= kShort;
  return taken_since_ == 0 || was_short || soon_again_ > 1;
}

void RateLimit::slow_down(Instant now) {
  const Duration slowest = std::max(allowed_, spacing_at(kSlowest));
  // The pause that worked last, or the average per accepted request with the storm, shows the server's rate.
  const Duration as_seen = taken_since_ == 0 ? last_storm_->worked
                           : soon_again_ > 1 ? last_storm_->on_average
                                             : Duration{0};
  const double factor = taken_since_ == 0 ? kFarOff : kSlightlyOff;
  rule_.spacing = std::min(slowest, std::max(times(rule_.spacing, factor), times(as_seen, kMargin)));
  learned_at_ = now;
}

void RateLimit::speed_up(Instant now) {
  if (rule_.spacing == allowed_ && !rule_.from_answers) return;
  if (now < learned_at_ + hold_ || taken_since_ < 2) return;
  if (rule_.spacing == allowed_ && single_ >= kOfAKind) return;
  tried_from_ = rule_;
  if (rule_.spacing == allowed_) {
    rule_.from_answers = false;
  } else {
    rule_.spacing = std::max(allowed_, times(rule_.spacing, kFaster));
  }
  learned_at_ = now;
}

LearnedRate RateLimit::learned_rate() const {
  return {.earliest = earliest(),
          .spacing = rule_.spacing > allowed_ ? rule_.spacing : Duration{0},
          .under_way = under_way_ > 0,
          .from_answers = rule_.from_answers,
          .single = single_ + (storm_ && storm_->counts_anew && storm_->is_one ? 1 : 0)};
}

void RateLimit::restore(const LearnedRate& learned, Instant now) {
  rule_.from_answers = learned.from_answers;
  single_ = learned.single;
  if (learned.spacing > allowed_) rule_.spacing = learned.spacing;
  if (learned.from_answers || learned.spacing > allowed_) learned_at_ = now;
  const Instant latest =
      now + std::max<Duration>(rule_.spacing, kLongestPause);  // a later time comes from another clock
  floor_.first = std::max(floor_.first, std::min(learned.earliest.first, latest));
  floor_.last = std::max(floor_.last, std::min(learned.earliest.last, latest));
  if (learned.under_way) counted_ = {.first = now, .last = now};
}

Turn oldest_first(std::span<const Candidate> candidates, Instant now) {
  Turn turn;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    if (!candidate.oldest) continue;
    if (candidate.ready > now) {
      turn.wake = std::min(turn.wake.value_or(candidate.ready), candidate.ready);
    } else if (!turn.candidate || *candidate.oldest < *candidates[*turn.candidate].oldest) {
      turn.candidate = i;
    }
  }
  if (turn.candidate) turn.wake.reset();
  return turn;
}

Turn first_ready(std::span<const Candidate> candidates, Instant now) {
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!candidates[i].oldest) continue;
    if (candidates[i].ready > now) return {.candidate = std::nullopt, .wake = candidates[i].ready};
    return {.candidate = i, .wake = std::nullopt};
  }
  return {};
}

}  // namespace adit::pace
