// RateLimit with several kinds of servers, in simulated time.
#include "pace/rate_limit.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pace/at.hpp"
#include "pace/hertz.hpp"

namespace adit::pace {
namespace {

using Seconds = std::chrono::duration<double>;
constexpr double kAnswerTakes = 0.03;

/// Whether a server accepts a request at that second.
using Server = std::function<bool(double)>;

/// Rejects everything from `begin` to `end`.
Server storm(double begin, double end) {
  return [=](double now) { return now < begin || now >= end; };
}

/// Accepts at least `apart` seconds after the last request, or after the last accepted one.
Server spaced(double apart, bool counts_refused) {
  return [=, last = -1e9](double now) mutable {
    const bool takes = now - last >= apart;
    if (takes || counts_refused) last = now;
    return takes;
  };
}

/// Accepts at most `most` requests in any `length` seconds.
Server window(std::size_t most, double length) {
  return [=, taken = std::deque<double>{}](double now) mutable {
    while (!taken.empty() && taken.front() <= now - length) taken.pop_front();
    if (taken.size() >= most) return false;
    taken.push_back(now);
    return true;
  };
}

struct Request {
  double at = 0;
  bool taken = false;
};

/// A client that always has a message to send.
std::vector<Request> played(Server server, double until,
                            std::optional<std::chrono::seconds> retry_after = {}) {
  RateLimit limit{1};
  std::vector<Request> all;
  double now = 0;
  while (now < until) {
    limit.on_sent(at(now));
    all.push_back({now, server(now)});
    const double answered = now + kAnswerTakes;
    all.back().taken ? limit.on_answered({.first = at(now), .last = at(now)}, at(answered))
                     : limit.on_throttled(at(answered), retry_after);
    now = std::max(answered, Seconds(limit.next().time_since_epoch()).count());
  }
  return all;
}

struct Counts {
  int taken = 0, refused = 0;
};
Counts counted(const std::vector<Request>& all, double from, double to) {
  Counts counts;
  for (const Request& request : all) {
    if (request.at >= from && request.at < to) ++(request.taken ? counts.taken : counts.refused);
  }
  return counts;
}

TEST(RateLimitServers, AllowedRateReturnsFiveSecondsAfterAStorm) {
  for (const double length : {1.0, 2.5, 4.0, 9.0, 15.0, 30.0, 55.0, 90.0, 600.0}) {
    for (const double begin : {0.0, 3.3, 10.7}) {
      const double end = begin + length;
      const auto all = played(storm(begin, end), end + 40);
      const Counts after = counted(all, end + 5, end + 35);
      EXPECT_EQ(after.refused, 0) << length << " s from " << begin;
      EXPECT_GE(after.taken, 28) << length << " s from " << begin << ": it is not at 1 Hz again";
    }
  }
}

TEST(RateLimitServers, SendTwentyOneMapsSoonAfterAStorm) {
  const auto all = played(storm(0, 9), 9 + 5 + 22);
  EXPECT_GE(counted(all, 9, 1000).taken, 21);
}

TEST(RateLimitServers, ReceiveABoundedNumberOfTriesInAStorm) {
  const Counts asked = counted(played(storm(0, 55), 55), 0, 55);
  EXPECT_LE(asked.refused, 18);
  EXPECT_GE(asked.refused, 12);
}

TEST(RateLimitServers, AllowedRateReturnsAfterTwoStorms) {
  const auto twice = [](double now) { return !(now < 9) && !(now >= 25 && now < 34); };
  const auto all = played(twice, 80);
  EXPECT_GE(counted(all, 39, 69).taken, 28);
}

TEST(RateLimitServers, AllowedRateReturnsAfterRetryAfter) {
  const auto all = played(storm(0, 9), 60, std::chrono::seconds(8));
  ASSERT_GE(all.size(), 3);
  EXPECT_NEAR(all[1].at, 8, 0.1);
  EXPECT_NEAR(all[2].at, 16, 0.2);
  EXPECT_GE(counted(all, 17, 47).taken, 28);
}

struct Limited {
  const char* what;
  Server server;
  double hertz;
};

TEST(RateLimitServers, LastingLimitIsLearnedAndUsed) {
  const Limited cases[] = {
      {"0.9 a second, counted from the last request", spaced(1 / 0.9, true), 0.9},
      {"0.9 a second, counted from the last taken", spaced(1 / 0.9, false), 0.9},
      {"0.5 a second, counted from the last request", spaced(2, true), 0.5},
      {"0.5 a second, counted from the last taken", spaced(2, false), 0.5},
      {"0.25 a second, counted from the last request", spaced(4, true), 0.25},
      {"9 in 10 seconds", window(9, 10), 0.9},
      {"5 in 10 seconds", window(5, 10), 0.5},
      {"30 in a minute", window(30, 60), 0.5},
  };
  for (const Limited& each : cases) {
    SCOPED_TRACE(each.what);
    const auto all = played(each.server, 780);
    const Counts late = counted(all, 180, 780);  // the first three minutes are for learning
    EXPECT_LE(late.refused, late.taken / 10) << "too many rejected requests";
    EXPECT_GE(late.taken, 0.6 * each.hertz * 600) << "too few accepted requests";
  }
}

TEST(RateLimitServers, LiftedLimitIsDetected) {
  const auto slow = std::make_shared<Server>(spaced(2, true));
  const auto all = played([slow](double now) { return now >= 120 || (*slow)(now); }, 420);
  EXPECT_GE(counted(all, 360, 420).taken, 56);
}

TEST(RateLimitServers, EndlessStormIsProbedRegularly) {
  const Counts asked = counted(played(storm(0, 1e9), 600), 120, 600);
  EXPECT_LE(asked.refused, 480 / 4 + 1);
  EXPECT_GE(asked.refused, 480 / 5);
}

/// At least a second from its answer to the first byte of the next request.
struct FromAnswers {
  double answered = -1e9;
  bool takes(double first) const { return first - answered >= 0.95; }  // "approximately"
};

constexpr double kTransfer = 0.5, kMinutes = 10;

/// A gateway that restarts every `lives` seconds, with the learned state of the one before.
Counts learns_of_answers(double lives) {
  FromAnswers server;
  RateLimit limit{1};
  Counts counts;
  double next_life = lives;
  for (double now = 0; now < kMinutes * 60;) {
    if (now > next_life) {
      next_life += lives;
      RateLimit next{1};
      next.restore(limit.learned_rate(), at(now));
      limit = next;
    }
    limit.on_sent(at(now));
    const double answered = now + kTransfer;
    const bool is_taken = server.takes(now);
    ++(is_taken ? counts.taken : counts.refused);
    server.answered = answered;
    is_taken ? limit.on_answered({.first = at(now), .last = at(answered)}, at(answered))
             : limit.on_throttled(at(answered), {});
    now = std::max(answered, Seconds(limit.earliest().first.time_since_epoch()).count());
  }
  return counts;
}

TEST(RateLimitServers, CountingFromAnswersIsLearnedAtOnce) {
  for (const double lives : {1e9, 12.0, 13.7, 31.0}) {
    const Counts counts = learns_of_answers(lives);
    EXPECT_EQ(counts.refused, 2) << "one at first, and one when it tries a higher rate; " << lives;
    EXPECT_GE(counts.taken, 0.94 * kMinutes * 60 / (1 + kTransfer)) << lives;
  }
}

TEST(RateLimit, AppliesANewRateAtOnce) {
  RateLimit rate(1);
  rate.on_sent(at(0));
  rate.on_lost(at(0));
  rate.allow(4, at(0.1));
  EXPECT_EQ(rate.next(), at(0.25));
  rate.allow(0.5, at(0.1));
  EXPECT_EQ(rate.next(), at(2));
}

TEST(RateLimit, NewRateKeepsARequestedPause) {
  RateLimit rate(1);
  rate.on_sent(at(0));
  rate.on_throttled(at(0), std::chrono::seconds{10});
  rate.allow(4, at(1));
  EXPECT_EQ(rate.next(), at(10));
}

TEST(RateLimit, NewRateBoundsAPauseFromBeforeARestart) {
  RateLimit rate(0.001);
  rate.restore({.earliest = {.first = at(900), .last = at(900)}}, at(0));
  rate.allow(1, at(5));
  EXPECT_EQ(rate.next(), at(5) + RateLimit::kLongestPause);
}

TEST(RateLimit, NewRateKeepsLearnedValues) {
  RateLimit rate(10);
  rate.restore({.spacing = std::chrono::seconds{2}}, at(0));
  rate.allow(5, at(0));
  EXPECT_DOUBLE_EQ(hertz(rate, 5), 0.5);
  rate.allow(0.1, at(0));
  EXPECT_DOUBLE_EQ(hertz(rate, 0.1), 0.1) << "never more than is allowed";
  rate.allow(10, at(0));
  EXPECT_DOUBLE_EQ(hertz(rate, 10), 10);
}

TEST(RateLimit, SpacesTheNextFromAnUnansweredRequest) {
  RateLimit rate(1);
  rate.on_sent(at(0));
  rate.on_departed({.first = at(0), .last = at(0.9)});
  EXPECT_EQ(rate.earliest(), (Span{.first = at(1.02), .last = at(1.92)}));
}

TEST(RateLimit, OfTwoInFlightTheLaterCounts) {
  for (const bool first_first : {true, false}) {
    RateLimit rate(1);
    rate.on_sent(at(0));
    rate.on_departed({.first = at(0), .last = at(0.9)});
    rate.on_sent(at(1.1), true);
    for (const bool is_first : {first_first, !first_first}) {
      EXPECT_TRUE(rate.learned_rate().under_way);
      is_first ? rate.on_answered({.first = at(0), .last = at(0.9)}, at(2.3))
               : rate.on_answered({.first = at(1.1), .last = at(2)}, at(2.3));
    }
    EXPECT_EQ(rate.earliest(), (Span{.first = at(2.12), .last = at(3.02)}));
    EXPECT_FALSE(rate.learned_rate().under_way);
  }
}

/// A request that fills the link takes that long to send.
TEST(RateLimit, NextMayBeginAtTheEndOfALongSend) {
  RateLimit rate(1);
  rate.on_sent(at(0));
  const Instant end = at(0) + rate.spacing();
  rate.on_departed({.first = at(0), .last = end});
  EXPECT_EQ(rate.earliest().first, end);
}

/// Otherwise its answer would end a pause that the server requested later.
TEST(RateLimit, RequestSentBeforeA429DoesNotEndTheStorm) {
  RateLimit rate(1);
  rate.on_sent(at(0));
  rate.on_sent(at(1.1), true);
  rate.on_throttled(at(1.2), std::chrono::seconds{10});
  rate.on_answered({.first = at(0), .last = at(0.9)}, at(1.3));
  EXPECT_EQ(rate.next(), at(11.2));
  rate.on_sent(at(11.2));
  rate.on_answered({.first = at(11.2), .last = at(11.2)}, at(11.3));
  EXPECT_EQ(rate.next(), at(12.3));
}

TEST(RateLimit, TwoThrottledRequestsAreOneStorm) {
  RateLimit once(1), twice(1);
  once.on_sent(at(0));
  twice.on_sent(at(0));
  twice.on_sent(at(1.1), true);
  twice.on_throttled(at(1.2), {});
  for (RateLimit* rate : {&once, &twice}) rate->on_throttled(at(1.2), {});
  EXPECT_EQ(once.next(), twice.next());
}

/// A storm from a request at 0 s to an answer at `end`.
RateLimit after_a_storm(double end) {
  RateLimit rate(1);
  rate.on_sent(at(0));
  rate.on_throttled(at(0.1), {});
  rate.on_sent(at(end - 0.1));
  rate.on_answered({.first = at(end - 0.1), .last = at(end - 0.1)}, at(end));
  return rate;
}

TEST(RateLimit, A429RightAfterAStormLearnsThePauseThatEndedIt) {
  RateLimit rate = after_a_storm(5.1);
  rate.on_sent(at(6.2));
  rate.on_throttled(at(6.3), {});
  EXPECT_EQ(rate.spacing(), std::chrono::milliseconds(5250));
}

TEST(RateLimit, OnlyAShortStormShowsALimit) {
  for (const double end : {5.0, 7.0}) {
    RateLimit rate = after_a_storm(end);
    rate.on_sent(at(end + 1.1));
    rate.on_answered({.first = at(end + 1.1), .last = at(end + 1.1)}, at(end + 1.2));
    rate.on_sent(at(end + 2.3));
    rate.on_throttled(at(end + 2.4), {});
    EXPECT_EQ(rate.spacing(), std::chrono::milliseconds(end < 6 ? 1250 : 1000)) << end;
  }
}

TEST(RateLimit, NothingGoesAheadWhileTheRateIsLearned) {
  RateLimit rate(1);
  EXPECT_TRUE(rate.can_pipeline());
  rate.on_sent(at(0));
  rate.on_throttled(at(0.1), {});
  EXPECT_FALSE(rate.can_pipeline());
  rate.on_sent(at(2));
  rate.on_answered({.first = at(2), .last = at(2)}, at(2.1));
  EXPECT_FALSE(rate.can_pipeline()) << "the server may count from its answers";
}

TEST(RateLimit, ForeignRequestTakesItsOwnTurn) {
  RateLimit rate(1);
  rate.on_sent(at(0));
  rate.on_answered({.first = at(0), .last = at(0)}, at(0.1));
  EXPECT_EQ(rate.claim(at(0.2), at(1.2)), std::nullopt) << "the turn is too late";
  EXPECT_EQ(rate.next(), at(1.02)) << "so no turn is reserved";
  EXPECT_EQ(rate.claim(at(0.2), at(5)), at(1.27))
      << "later than possible, because it uses another connection";
  EXPECT_EQ(rate.next(), at(2.52));
  rate.on_claimed(at(1.4));
  EXPECT_EQ(rate.next(), at(2.65)) << "the answer may have been read that late";
  EXPECT_EQ(rate.claim(at(9), at(9)), at(9)) << "at once if no request was sent recently";
}

TEST(RateLimit, ForeignRequestTeachesNothing) {
  RateLimit rate(1);
  rate.on_sent(at(0));
  rate.on_throttled(at(0.1), {});
  const Instant next = rate.next();
  const auto claimed = rate.claim(at(0.2), at(30));
  ASSERT_TRUE(claimed);
  EXPECT_GT(*claimed, next) << "a claim also keeps the pause";
  rate.on_claimed(*claimed + std::chrono::milliseconds{100});
  EXPECT_GE(rate.next(), *claimed + std::chrono::milliseconds{1100}) << "this server counts from its answers";
  EXPECT_FALSE(rate.can_pipeline()) << "the storm continues";
  EXPECT_FALSE(rate.learned_rate().under_way);
}

}  // namespace
}  // namespace adit::pace
