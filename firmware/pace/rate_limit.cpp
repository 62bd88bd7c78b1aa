#include "pace/rate_limit.hpp"

#include <algorithm>
#include <utility>

namespace adit::pace {
namespace {

using Seconds = std::chrono::duration<double>;

/// Longer spacing where a 429 comes again at once, where one comes now and then, and shorter for a trial.
constexpr double kFarOff = 1.5, kSlightlyOff = 1.25, kFaster = 0.67;
/// What worked once is taken a little slower from then on: networks do not keep time to the millisecond.
constexpr double kMargin = 1.05;

/// Between two requests at `hertz`; a rate too low to matter in any run does not overflow.
Duration spacing(double hertz) {
  constexpr Seconds kLongest = std::chrono::hours{24};
  return std::chrono::duration_cast<Duration>(std::min(Seconds{1 / hertz}, kLongest));
}

Duration times(Duration duration, double factor) {
  return std::chrono::duration_cast<Duration>(Seconds{duration} * factor);
}

}  // namespace

RateLimit::RateLimit(double hertz) : allowed_(spacing(hertz)), spacing_(allowed_) {}

void RateLimit::allow(double hertz, Instant now) {
  const Duration before = std::exchange(allowed_, spacing(hertz));
  if (allowed_ == before) return;
  const bool is_learned = spacing_ > before;
  const Instant by_the_rate = counted_.value_or(Instant{}) + spacing_;
  spacing_ = is_learned ? std::max(spacing_, allowed_) : allowed_;
  if (tried_from_ && *tried_from_ <= allowed_) tried_from_.reset();
  if (counted_ && next_ == by_the_rate) {
    next_ = *counted_ + spacing_;
  } else {  // a server asked for the pause, or it is of an earlier life
    next_ = std::min(next_, now + std::max<Duration>(spacing_, kLongestPause));
  }
}

void RateLimit::sent(Instant now) {
  if (storm_ && sent_) worked_ = now - *sent_;
  sent_ = now;
  under_way_ = true;
  space_from(now);
}

void RateLimit::taken(Instant now) {
  under_way_ = false;
  if (storm_) {
    last_was_short_ = now - storm_->began <= kShort;
    if (calm_since_) on_average_ = (now - *calm_since_) / (taken_since_ + 1);
    calm_since_ = now;
    taken_since_ = 0;
    storm_.reset();
  } else {
    ++taken_since_;
    speed_up(now);
  }
  next_ = {};
  space_from(now);
}

void RateLimit::lost(Instant now) {
  under_way_ = false;
  space_from(now);
}

void RateLimit::space_from(Instant now) {
  if (now + spacing_ < next_) return;
  next_ = now + spacing_;
  counted_ = now;
}

void RateLimit::throttled(Instant now, std::optional<std::chrono::seconds> retry_after) {
  under_way_ = false;
  if (!storm_) {
    begin_storm(now);
  } else {
    storm_->pause = std::max(allowed_, std::min<Duration>(storm_->pause * 2, kStormPause));
  }
  const auto asked = std::clamp(retry_after.value_or(std::chrono::seconds{0}), {}, kLongestPause);
  next_ = now + std::max<Duration>({storm_->pause, spacing_, asked});
}

void RateLimit::begin_storm(Instant now) {
  soon_again_ = calm_since_ && now - *calm_since_ <= kSoonAgain ? soon_again_ + 1 : 0;
  const auto tried_from = std::exchange(tried_from_, std::nullopt);
  if (tried_from && now - learned_at_ <= kSoonAgain) {  // the step up was one too many
    spacing_ = *tried_from;
    learned_at_ = now;
    hold_ = std::min<Duration>(hold_ * 2, kLongestHold);
  } else if (is_a_limit()) {
    slow_down(now);
  }
  storm_ = Storm{.began = now, .pause = allowed_};
}

bool RateLimit::is_a_limit() const {
  if (soon_again_ == 0) return false;
  return taken_since_ == 0 || last_was_short_ || soon_again_ > 1;
}

void RateLimit::slow_down(Instant now) {
  const Duration slowest = std::max(allowed_, spacing(kSlowest));
  // What the server let through before it refused again, and how long it then refused, is its rate.
  const Duration as_seen = taken_since_ == 0 ? worked_ : soon_again_ > 1 ? on_average_ : Duration{0};
  const double factor = taken_since_ == 0 ? kFarOff : kSlightlyOff;
  spacing_ = std::min(slowest, std::max(times(spacing_, factor), times(as_seen, kMargin)));
  learned_at_ = now;
}

void RateLimit::speed_up(Instant now) {
  if (spacing_ == allowed_) return;
  if (now < learned_at_ + hold_ || taken_since_ < 2) return;
  tried_from_ = spacing_;
  spacing_ = std::max(allowed_, times(spacing_, kFaster));
  learned_at_ = now;
}

Learned RateLimit::learned() const {
  return {.next = next_, .spacing = spacing_ > allowed_ ? spacing_ : Duration{0}, .under_way = under_way_};
}

void RateLimit::carry_on(const Learned& learned, Instant now) {
  if (learned.spacing > allowed_) {
    spacing_ = learned.spacing;
    learned_at_ = learned.next;
  }
  const Instant latest =
      now + std::max<Duration>(spacing_, kLongestPause);  // a later one is of another clock
  next_ = std::max(next_, std::min(learned.next, latest));
  if (learned.under_way) next_ = std::max(next_, now + spacing_);
}

}  // namespace adit::pace
