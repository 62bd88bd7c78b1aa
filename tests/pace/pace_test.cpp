#include <gmock/gmock.h>

#include <limits>
#include <random>
#include <utility>

#include "pace/at.hpp"
#include "pace/hertz.hpp"
#include "pace/rate_limit.hpp"

namespace adit::pace {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::DoubleNear;

/// A request so short that it left at once.
Span left(double s) {
  return {.first = at(s), .last = at(s)};
}

Duration seconds_of(double s) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>{s});
}

TEST(RateLimit, IsReadyAtOnceAndThenAfterItsSpacing) {
  RateLimit limit{2};
  EXPECT_TRUE(limit.ready(at(0)));
  limit.on_sent(at(10));
  EXPECT_FALSE(limit.ready(at(10.49)));
  EXPECT_TRUE(limit.ready(at(10.5)));
}

TEST(RateLimit, KeepsFirstBytesApartAndLastBytes) {
  RateLimit limit{1};
  limit.on_sent(at(10));
  limit.on_answered({.first = at(10), .last = at(10.6)}, at(10.7));
  EXPECT_EQ(limit.earliest(), (Span{.first = at(11.02), .last = at(11.62)}));
  EXPECT_EQ(limit.next(), at(11.62)) << "without a byte that is held back";
}

TEST(RateLimit, After429CountsFromTheAnswer) {
  RateLimit limit{1};
  limit.on_sent(at(10));
  limit.on_throttled(at(10.1), {});
  limit.on_sent(at(11.2));
  limit.on_answered({.first = at(11.2), .last = at(11.5)}, at(11.7));
  EXPECT_EQ(limit.earliest(), (Span{.first = at(12.7), .last = at(12.7)}));
  EXPECT_TRUE(limit.learned_rate().from_answers);
  RateLimit next{1};
  next.restore(limit.learned_rate(), at(12));
  EXPECT_TRUE(next.learned_rate().from_answers);
  EXPECT_EQ(next.earliest(), limit.earliest());
}

TEST(RateLimit, ObeysRetryAfterUpToALimit) {
  struct Case {
    seconds retry_after;
    double next;
  };
  const Case cases[] = {{seconds{7}, 7},     {seconds{0}, 1},      {seconds{-5}, 1},
                        {seconds{3600}, 30}, {seconds::max(), 30}, {seconds::min(), 1}};
  for (const auto& [retry_after, next] : cases) {
    RateLimit limit{1};
    limit.on_throttled(at(0), retry_after);
    EXPECT_EQ(limit.next(), at(next)) << retry_after.count();
  }
}

TEST(RateLimit, PausesForALimitedTime) {
  RateLimit limit{1};
  for (int i = 0; i < 100; ++i) limit.on_throttled(at(i), {});
  EXPECT_GE(hertz(limit, 1), RateLimit::kSlowest);
  EXPECT_LE(limit.next(), at(99 + 30.1));
}

TEST(RateLimit, ContinuesWithLearnedValues) {
  RateLimit slowed(1);
  for (int i = 0; i < 40; ++i) slowed.on_throttled(at(i), {}), slowed.on_answered(left(i), at(i));
  ASSERT_LT(hertz(slowed, 1), 0.9);
  slowed.on_throttled(at(40), std::chrono::seconds(20));
  RateLimit next(1);
  next.restore(slowed.learned_rate(), at(41));
  EXPECT_EQ(next.next(), slowed.next());
  EXPECT_GE(next.next(), at(60)) << "including the server's Retry-After";
  EXPECT_EQ(next.learned_rate().spacing, slowed.learned_rate().spacing);
  RateLimit slower(0.01);
  slower.restore(slowed.learned_rate(), at(41));
  EXPECT_EQ(hertz(slower, 0.01), 0.01) << "never more than the settings allow";
  RateLimit free(1), freed(5);
  free.on_sent(at(3));
  free.on_answered(left(3), at(3));
  freed.restore(free.learned_rate(), at(3));
  EXPECT_EQ(freed.next(), at(4) + milliseconds{20});
  EXPECT_EQ(hertz(freed, 5), 5) << "without a learned rate the new settings apply";
}

/// The request may have ended just before. In one process the spacing counts from there.
TEST(RateLimit, KeepsItsSpacingAfterARestartDuringARequest) {
  RateLimit before(1);
  before.on_sent(at(3));  // and it took five seconds
  RateLimit next(1);
  next.restore(before.learned_rate(), at(8.3));
  EXPECT_EQ(next.next(), at(9.3));
  before.on_answered(left(8), at(8));
  RateLimit known(1);
  known.restore(before.learned_rate(), at(8.3));
  EXPECT_EQ(known.next(), at(9) + milliseconds{20}) << "the end of the request is known";
}

TEST(RateLimit, SurvivesTimesOfAnotherClock) {
  for (const double hertz : {1.0, 0.01}) {
    RateLimit next(hertz);
    next.restore({.earliest = {.first = at(1e6), .last = at(1e6)}}, at(5));
    EXPECT_LE(next.next(), at(5 + std::max(30.0, 1 / hertz))) << hertz;
  }
}

TEST(RateLimit, StaysBelowASlowRate) {
  RateLimit limit{0.01};
  limit.on_throttled(at(0), {});
  EXPECT_EQ(hertz(limit, 0.01), 0.01);
  RateLimit slowest{std::numeric_limits<double>::denorm_min()};
  slowest.on_sent(at(0));
  EXPECT_FALSE(slowest.ready(at(3600)));
}

TEST(RateLimit, KeepsRequestsApartForAnyAnswers) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> any{0, 1};
  for (const double allowed : {0.5, 1.0, 10.0}) {
    RateLimit limit{allowed};
    auto now = at(0);
    Span last{.first = at(-100), .last = at(-100)};
    for (int i = 0; i < 2000; ++i) {
      now += seconds_of(any(random) * 0.3);
      if (now < limit.earliest().first) continue;
      const Span sent{.first = now,
                      .last = std::max(now + seconds_of(any(random) * 2), limit.earliest().last)};
      ASSERT_GE(sent.first - last.first, seconds_of(1 / allowed));
      ASSERT_GE(sent.last - last.last, seconds_of(1 / allowed));
      last = sent;
      limit.on_sent(sent.first);
      now = sent.last + milliseconds{20};
      const double answer = any(random);
      if (answer < 0.2) limit.on_throttled(now, {});
      if (answer >= 0.2 && answer < 0.4) limit.on_lost(now);
      if (answer >= 0.4) limit.on_answered(sent, now);
      if (answer > 0.98) {  // a process ends, and the next begins
        const LearnedRate learned = std::exchange(limit, RateLimit{allowed}).learned_rate();
        limit.restore(learned, now);
      }
      ASSERT_GE(hertz(limit, allowed), std::min(allowed, RateLimit::kSlowest) - 1e-9);
    }
  }
}

TEST(Backoff, DoublesUpToALimitAndRestartsAfterSuccess) {
  Backoff backoff{milliseconds{500}, milliseconds{3000}};
  for (const int wait : {500, 1000, 2000, 3000, 3000}) EXPECT_EQ(backoff.on_failed(0), milliseconds{wait});
  backoff.on_succeeded();
  EXPECT_EQ(backoff.on_failed(0), milliseconds{500});
}

TEST(Backoff, AddsUpToAQuarterAtRandom) {
  Backoff backoff{milliseconds{1000}, milliseconds{1000}};
  EXPECT_EQ(backoff.on_failed(0.5), milliseconds{1125});
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> any{0, 1};
  for (int i = 0; i < 1000; ++i) {
    const auto wait = backoff.on_failed(any(random));
    ASSERT_GE(wait, milliseconds{1000});
    ASSERT_LT(wait, milliseconds{1250});
  }
}

TEST(Backoff, StaysWithinItsLimit) {
  Backoff backoff{milliseconds{7}, std::chrono::hours{24 * 365}};
  for (int i = 0; i < 200; ++i) EXPECT_LE(backoff.on_failed(0), std::chrono::hours{24 * 365});
  Backoff turned_round{milliseconds{500}, milliseconds{100}};
  EXPECT_EQ(turned_round.on_failed(0), milliseconds{100});
}

TEST(Budget, LeavesRoomForReports) {
  EXPECT_THAT(static_cast<double>(map_bytes_per_second(100)), DoubleNear(11.5e6, 0.05e6));
  for (const double megabit : {0.5, 10.0, 100.0, 1000.0}) {
    const double on_the_wire = static_cast<double>(map_bytes_per_second(megabit)) * 8 * 1538 / 1448;
    EXPECT_LT(on_the_wire, megabit * 1e6 * 0.985);
    EXPECT_GT(on_the_wire, megabit * 1e6 * 0.95);
  }
}

TEST(Budget, IsNeverZero) {
  EXPECT_GE(map_bytes_per_second(1e-12), 1) << "0 would mean no pacing at all";
  EXPECT_GT(map_bytes_per_second(std::numeric_limits<double>::max()), 0);
}

TEST(RateLimit, CountsFromTheEndOfALostRequest) {
  RateLimit limit(1);
  limit.on_sent(at(10));  // its bytes left at 12.8, and no answer came
  limit.on_lost(at(12.9));
  EXPECT_EQ(limit.next(), at(13.9));
}

}  // namespace
}  // namespace adit::pace
