#include "forward/slot.hpp"

#include <gtest/gtest.h>

namespace adit::forward {
namespace {

using std::chrono::milliseconds;

using queues::Precision;
constexpr loop::Instant kBegin{std::chrono::seconds(100)};
constexpr std::size_t kMegabyte = 1'000'000;

uplink::SendTimes sent_in(milliseconds took) {
  return {.first = kBegin, .last = kBegin + took};
}

/// Bytes of exact points in this time.
std::size_t exact_in(const Slot& slot, int seconds) {
  return slot.points_for(std::chrono::seconds(seconds))[0];
}

TEST(Slot, HoldsMoreRoundedPoints) {
  Slot slot(10 * kMegabyte);
  const queues::PointsAt at_first = slot.points_for(std::chrono::seconds(1));
  EXPECT_LT(at_first[0], at_first[1]);
  EXPECT_LT(at_first[1], at_first[2]);
  slot.on_packed(4 * kMegabyte, kMegabyte, Precision::EightMillimetres);
  EXPECT_EQ(slot.points_for(std::chrono::seconds(1))[2], 40 * kMegabyte);
  EXPECT_LT(exact_in(slot, 1), 40 * kMegabyte) << "exact points pack less well";
}

TEST(Slot, HoldsTheBudgetOfMapsAtFirst) {
  const Slot slot(10 * kMegabyte);
  EXPECT_EQ(exact_in(slot, 1), 10 * kMegabyte);
  EXPECT_EQ(exact_in(slot, 2), 20 * kMegabyte);
  EXPECT_EQ(slot.transfer(5 * kMegabyte), milliseconds(500));
}

TEST(Slot, HoldsMoreOfCloudsThatPackWell) {
  Slot slot(10 * kMegabyte);
  slot.on_packed(4 * kMegabyte, kMegabyte, Precision::Exact);
  EXPECT_EQ(exact_in(slot, 1), 40 * kMegabyte);
  slot.on_packed(4 * kMegabyte, 5 * kMegabyte, Precision::Exact);
  EXPECT_EQ(exact_in(slot, 1), 10 * kMegabyte);
}

TEST(Slot, FollowsTheMeasuredLink) {
  Slot slot(10 * kMegabyte);
  slot.on_sent(4 * kMegabyte, sent_in(std::chrono::seconds(1)), kBegin);
  EXPECT_EQ(exact_in(slot, 1), 4 * kMegabyte);
  slot.on_sent(8 * kMegabyte, sent_in(std::chrono::seconds(1)), kBegin);
  EXPECT_EQ(exact_in(slot, 1), 8 * kMegabyte);
  slot.on_sent(80 * kMegabyte, sent_in(std::chrono::seconds(1)), kBegin);
  EXPECT_EQ(exact_in(slot, 1), 10 * kMegabyte) << "the budget is the limit";
}

TEST(Slot, HoldsLessIfTheLinkDeliversLess) {
  Slot slot(10 * kMegabyte);
  slot.set_link_rate(0);  // unknown
  EXPECT_EQ(exact_in(slot, 1), 10 * kMegabyte);
  slot.set_link_rate(6 * kMegabyte);
  slot.set_link_rate(9 * kMegabyte);
  EXPECT_EQ(exact_in(slot, 1), 6 * kMegabyte) << "until a map leaves faster";
  slot.on_sent(6 * kMegabyte, sent_in(milliseconds(600)), {});
  EXPECT_EQ(exact_in(slot, 1), 10 * kMegabyte);
}

TEST(Slot, IgnoresTimeBeforeTheSlot) {
  Slot slot(10 * kMegabyte);
  slot.on_sent(kMegabyte, sent_in(std::chrono::seconds(1)), kBegin + std::chrono::seconds(1));
  EXPECT_EQ(exact_in(slot, 1), 10 * kMegabyte);
}

TEST(Slot, LeadsByTheLongestRecentPacking) {
  Slot slot(10 * kMegabyte);
  EXPECT_EQ(slot.lead(), loop::Duration(0));
  slot.on_packing_done(milliseconds(600));
  slot.on_packing_done(milliseconds(300));
  EXPECT_GT(slot.lead(), milliseconds(500));
  for (int i = 0; i < 50; ++i) slot.on_packing_done(milliseconds(300));
  EXPECT_LT(slot.lead(), milliseconds(310));
  EXPECT_GE(slot.lead(), milliseconds(300));
}

TEST(Slot, LimitsItsLead) {
  Slot slot(10 * kMegabyte);
  slot.on_packing_done(std::chrono::seconds(60));
  EXPECT_EQ(slot.lead(), loop::Duration(Slot::kLongestLead));
}

TEST(Slot, DetectsThatASlowLinkIsFastAgain) {
  Slot slot(10 * kMegabyte);
  slot.on_sent(kMegabyte, sent_in(std::chrono::seconds(1000)), kBegin);
  const std::size_t few = exact_in(slot, 1);
  EXPECT_LT(few, kMegabyte);
  slot.on_sent(few, sent_in(milliseconds(1)), kBegin);
  EXPECT_EQ(exact_in(slot, 1), 10 * kMegabyte);
}

TEST(Slot, HasTheFiguresForTheEffort) {
  Slot slot(10 * kMegabyte);
  const auto hurry = [&slot] { return slot.effort_input(std::chrono::seconds(2)); };
  EXPECT_EQ(hurry().bytes_per_second, 10 * kMegabyte);
  slot.on_sent(2 * kMegabyte, sent_in(std::chrono::seconds(1)), kBegin);
  EXPECT_EQ(hurry().bytes_per_second, 2 * kMegabyte);
  EXPECT_EQ(hurry().longest, 2);
}

TEST(Slot, LearnsHowSlowTheBoxIs) {
  Slot slot(10 * kMegabyte);
  const auto slowness = [&slot] { return slot.effort_input(std::chrono::seconds(1)).slowness; };
  EXPECT_EQ(slowness(), 1);
  for (const double little : {0.0, 0.0004}) slot.on_work_done(std::chrono::seconds(1), little);
  EXPECT_EQ(slowness(), 1) << "too short to measure";
  for (int i = 0; i < 20; ++i) slot.on_work_done(milliseconds(60), 0.015);
  EXPECT_NEAR(slowness(), 4, 0.01);
  for (int i = 0; i < 20; ++i) slot.on_work_done(milliseconds(1), 0.1);
  EXPECT_EQ(slowness(), 0.5) << "the lower limit";
}

TEST(Slot, ForgetsAStallOfTheWorker) {
  Slot slot(10 * kMegabyte);
  const auto slowness = [&slot] { return slot.effort_input(std::chrono::seconds(1)).slowness; };
  slot.on_work_done(std::chrono::seconds(10), 0.1);
  const double stalled = slowness();
  EXPECT_GT(stalled, 50);
  slot.on_work_done(milliseconds(1), 0);
  EXPECT_LT(slowness(), stalled);
  EXPECT_GT(slowness(), 0.9 * stalled) << "one sample weighs little";
  for (int i = 0; i < 500; ++i) slot.on_work_done(milliseconds(1), 0);
  EXPECT_NEAR(slowness(), 1, 0.01);
}

TEST(Slot, HoldsNoMoreThanTheEndpointAccepts) {
  Slot slot(10 * kMegabyte);
  slot.on_passed(kMegabyte / 2);
  EXPECT_EQ(exact_in(slot, 1), 10 * kMegabyte);
  slot.on_too_large(4 * kMegabyte);
  EXPECT_EQ(slot.limit(), 2 * kMegabyte);
  EXPECT_EQ(exact_in(slot, 1), 1'800'000) << "clouds do not all pack alike";
  slot.on_too_large(3 * kMegabyte / 2);
  slot.on_too_large(kMegabyte * 3 / 4);
  EXPECT_EQ(slot.limit(), kMegabyte / 2) << "such a message has passed";
  slot.on_passed(kMegabyte);
  EXPECT_EQ(slot.limit(), kMegabyte) << "a larger one has passed";
  slot.on_too_large(kMegabyte);
  EXPECT_EQ(slot.limit(), kMegabyte) << "others may send as much";
  for (int i = 0; i < Slot::kTryLarger; ++i) slot.on_passed(1);
  EXPECT_EQ(exact_in(slot, 1), 10 * kMegabyte) << "the limit may be gone";
  slot.on_too_large(4 * kMegabyte);
  EXPECT_EQ(slot.limit(), kMegabyte) << "it was not";
  slot.forget_sizes();
  EXPECT_EQ(exact_in(slot, 1), 10 * kMegabyte);
}

}  // namespace
}  // namespace adit::forward
