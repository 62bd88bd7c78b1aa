// The delivery rate of a link, and the pace, on a simulated link with a queue.
#include "pace/delivery.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <utility>

#include "pace/at.hpp"

namespace adit::pace {
namespace {

constexpr double kMost = 11.5e6;  // bytes a second
constexpr double kStep = 0.001;   // seconds

Duration lasting(double s) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>{s});
}

/// A sender that always has data, its TCP, and a link with a queue.
class Line {
 public:
  Line(double bytes_per_second, double round_trip) : carries(bytes_per_second), round_trip_(round_trip) {}

  /// Sends for `s` seconds and returns the delivered bytes per second.
  double runs(double s) {
    const double before = delivered_, end = time_ + s;
    most_queued = 0;
    for (; time_ < end; time_ += kStep) step();
    return (delivered_ - before) / s;
  }
  /// Sends nothing for `s` seconds.
  void rests(double s) {
    time_ += s;
    queue_ = 0;
    delivery.on_write_begun(progress());
  }

  double carries;          // bytes a second
  double burst = 0;        // bytes that pass at once after a pause, as in a token bucket
  double most_queued = 0;  // longest wait of a report in seconds
  bool starves = false;    // the sender is sometimes busy with other work
  Delivery delivery{kMost};

 private:
  /// Limit of the bytes in TCP and the kernel: in flight or queued.
  static constexpr double kWindow = 512e3;

  void step() {
    const bool rests = starves && static_cast<int>(time_ / kStep) % 40 < 20;
    const double gives = rests ? 0 : std::min(delivery.pace() * kStep, kWindow - queue_);
    queue_ += gives;
    tokens_ = std::min(burst, tokens_ + carries * kStep);
    const double passes = std::min(queue_, burst > 0 ? tokens_ : carries * kStep);
    tokens_ -= passes;
    queue_ -= passes;
    delivered_ += passes;
    const double waits = queue_ / carries;
    told_.emplace_back(delivered_, waits);
    if (told_.size() > 1 && static_cast<double>(told_.size()) * kStep > round_trip_) told_.pop_front();
    smoothed_ += (told_.front().second - smoothed_) / 4;
    most_queued = std::max(most_queued, waits);
    Progress now = progress();
    const bool is_full = queue_ + delivery.pace() * kStep >= kWindow;
    now.unsent = rests || is_full ? 0 : 1;
    now.in_flight = static_cast<std::size_t>(queue_);
    if (static_cast<int>(time_ / kStep) % 4 == 0) delivery.on_write(now);
  }

  Progress progress() const {
    return {.at = at(time_),
            .delivered = static_cast<std::uint64_t>(told_.empty() ? 0 : told_.front().first),
            .round_trip = lasting(round_trip_ + smoothed_),
            .least_round_trip = lasting(round_trip_)};
  }

  double round_trip_;
  std::deque<std::pair<double, double>>
      told_;  // in flight to the sender: delivered bytes, and how long they waited
  double time_ = 10, queue_ = 0, tokens_ = 0, delivered_ = 0, smoothed_ = 0;
};

TEST(Delivery, MatchesAFullLink) {
  Line line(12.5e6, 0.001);
  EXPECT_NEAR(line.runs(5), kMost, kMost / 100);
  EXPECT_EQ(line.delivery.pace(), kMost);
  EXPECT_NEAR(line.delivery.delivery_rate(), kMost, kMost / 50);
}

TEST(Delivery, FollowsALinkThatSlowsDownAndRecovers) {
  Line line(12.5e6, 0.001);
  line.runs(3);
  line.carries = 7.5e6;
  line.runs(1);
  EXPECT_GT(line.runs(2), 0.95 * 7.5e6);
  EXPECT_NEAR(line.delivery.delivery_rate(), 7.5e6, 0.75e6);
  EXPECT_LT(line.most_queued, 0.012);
  line.carries = 12.5e6;
  line.runs(2);
  EXPECT_GT(line.runs(0.5), 0.95 * kMost);
}

TEST(Delivery, IgnoresABusySender) {
  Line line(12.5e6, 0.001);
  line.starves = true;
  line.runs(5);
  EXPECT_EQ(line.delivery.pace(), kMost);
  EXPECT_EQ(line.delivery.delivery_rate(), kMost);
}

TEST(Delivery, IgnoresALongFirstRoundTrip) {
  Delivery delivery(kMost);
  Progress now{.at = at(10), .unsent = 1, .round_trip = std::chrono::milliseconds(40)};
  delivery.on_write_begun(now);
  for (int i = 0; i < 1000; ++i) {
    now.at += std::chrono::milliseconds(4);
    now.delivered += 46'000;
    now.round_trip = now.round_trip * 7 / 8;
    delivery.on_write(now);
    ASSERT_EQ(delivery.pace(), kMost) << i;
  }
}

/// Small maps: TCP has sent all bytes of each, and a late ACK of the last bytes made the round trip longer.
TEST(Delivery, IgnoresALateAcknowledgementOfAnIdleSender) {
  Delivery delivery(kMost);
  Progress now{.at = at(10),
               .in_flight = 1448,
               .round_trip = std::chrono::milliseconds(6),
               .least_round_trip = std::chrono::microseconds(100)};
  delivery.on_write_begun(now);
  for (int i = 0; i < 1000; ++i) {
    now.at += std::chrono::milliseconds(100);
    now.delivered += 20'000;
    delivery.on_write(now);
    ASSERT_EQ(delivery.pace(), kMost) << i;
  }
}

TEST(Delivery, IgnoresSilence) {
  Delivery delivery(kMost);
  Progress now{.at = at(10), .unsent = 1, .round_trip = std::chrono::milliseconds(40)};
  delivery.on_write_begun(now);
  for (int i = 0; i < 1000; ++i) {
    now.at += std::chrono::milliseconds(50);
    delivery.on_write(now);
  }
  EXPECT_EQ(delivery.pace(), kMost);
}

/// For any link: after 2 s, 95 % of it is used and a report waits at most 30 ms.
TEST(Delivery, RecoversWithinTwoSecondsOnAnyLink) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    Line line(between(1e6, 15e6), between(0.0001, 0.02));
    if (seed % 2 == 0) line.burst = between(20e3, 40e3);
    for (int change = 0; change < 5; ++change) {
      if (change > 0) line.carries = between(1e6, 15e6);
      if (seed % 3 == 0) line.rests(between(0.1, 3));
      line.runs(2);
      const double used = line.runs(2) / std::min(line.carries, kMost);
      EXPECT_GT(used, 0.95) << "seed " << seed << " change " << change << " link " << line.carries;
      if (line.carries > 0.97 * kMost && line.carries < kMost) continue;  // indistinguishable from the limit
      EXPECT_LT(line.most_queued, 0.03 + 3 * line.burst / line.carries)
          << "seed " << seed << " change " << change << " link " << line.carries;
    }
  }
}

}  // namespace
}  // namespace adit::pace
