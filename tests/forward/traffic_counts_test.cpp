#include "forward/traffic_counts.hpp"

#include <gtest/gtest.h>

namespace adit::forward {
namespace {

const Traffic kCloudOfR1{TrafficKind::Cloud, "r1"};

TEST(TrafficCounts, CountsTheMapsOfEachRobot) {
  int changes = 0;
  TrafficCounts counts([&] { ++changes; });
  counts.count_accepted(kCloudOfR1, 1000, 10.0);
  counts.count_accepted(kCloudOfR1, 1100, 11.0);
  counts.rounded_to(kCloudOfR1, queues::Precision::EightMillimetres);
  counts.count_forwarded(kCloudOfR1, 2, 900, 200, 12.0);
  counts.count_accepted({TrafficKind::Grid, "r1"}, 5, 13.0);
  counts.count_undelivered({TrafficKind::Grid, "r1"}, DeliveryFailure::Throttled, 429, "too frequent");

  ASSERT_EQ(counts.rows().size(), 2u);
  const facts::ActivityRow &grid = counts.rows().at({TrafficKind::Grid, "r1"}),
                           &cloud = counts.rows().at(kCloudOfR1);
  EXPECT_EQ(grid.kind, "grid");
  EXPECT_EQ(grid.throttled, 1u);
  EXPECT_EQ(grid.last_sentence, "too frequent");
  EXPECT_FALSE(grid.last_forwarded);
  EXPECT_EQ(cloud.kind, "cloud");
  EXPECT_EQ(cloud.accepted, 2u);
  EXPECT_EQ(cloud.forwarded, 1u);
  EXPECT_EQ(cloud.merged, 1u);
  EXPECT_EQ(cloud.last_forwarded, 12.0);
  EXPECT_EQ(cloud.bytes_received, 1100u);
  EXPECT_EQ(cloud.bytes_sent, 900u);
  EXPECT_EQ(cloud.last_status, 200);
  EXPECT_EQ(cloud.precision, "8mm");
  EXPECT_EQ(grid.precision, "");
  EXPECT_EQ(changes, 5);
}

TEST(TrafficCounts, ClearsTheSentenceOnceAMessageIsDelivered) {
  TrafficCounts counts([] {});
  counts.count_undelivered(kCloudOfR1, DeliveryFailure::Failed, 0, "connection reset");
  counts.count_forwarded(kCloudOfR1, 1, 10, 200, 1.0);
  EXPECT_EQ(counts.rows().at(kCloudOfR1).last_sentence, "");
  EXPECT_EQ(counts.rows().at(kCloudOfR1).failed, 1u);
}

TEST(TrafficCounts, CountsRobotsBeyondTheLastRowTogether) {
  TrafficCounts counts([] {});
  for (std::size_t i = 0; i < 2 * TrafficCounts::kMostRows; ++i)
    counts.count_accepted({TrafficKind::State, std::to_string(i)}, 1, 0.0);
  const auto& rows = counts.rows();
  EXPECT_LE(rows.size(), TrafficCounts::kMostRows + 1);
  std::uint64_t accepted = 0;
  for (const auto& [traffic, row] : rows) accepted += row.accepted;
  EXPECT_EQ(accepted, 2 * TrafficCounts::kMostRows);
}

TEST(TrafficCounts, HasTheTimeOfTheLastFullQueue) {
  TrafficCounts counts([] {});
  counts.no_room(kCloudOfR1, 10);
  counts.no_room({TrafficKind::Markers, ""}, 20);
  counts.no_room({TrafficKind::Markers, ""}, 21);
  EXPECT_EQ(counts.rows().at({TrafficKind::Markers, ""}).no_room, 2u);
  EXPECT_EQ(counts.rows().at({TrafficKind::Markers, ""}).last_no_room, 21);
  EXPECT_EQ(counts.rows().at(kCloudOfR1).last_no_room, 10);
}

TEST(TrafficCounts, KeepsTheLastRejectionsNewestFirst) {
  TrafficCounts counts([] {});
  for (std::size_t i = 0; i < TrafficCounts::kMostRefusals + 5; ++i) {
    counts.count_rejected(icd::Uri::MapUpdate, {"10.0.0.5", 3},
                          {icd::Status::UnprocessableEntity, std::to_string(i)}, double(i));
  }
  const auto rows = counts.refusals();
  ASSERT_EQ(rows.size(), TrafficCounts::kMostRefusals);
  EXPECT_EQ(rows.front().sentence, std::to_string(TrafficCounts::kMostRefusals + 4));
  EXPECT_EQ(rows.front().uri, "/map/update");
  EXPECT_EQ(rows.front().sender, "10.0.0.5");
  EXPECT_EQ(rows.front().status, 422);
}

TEST(TrafficCounts, CountsRejectionsByUriAndStatus) {
  TrafficCounts counts([] {});
  for (std::size_t i = 0; i < TrafficCounts::kMostRefusals + 5; ++i) {
    counts.count_rejected(icd::Uri::MapUpdate, {"10.0.0.5", 3}, {icd::Status::UnprocessableEntity, "why"}, 0);
  }
  counts.count_rejected(icd::Uri::StateUpdate, {"10.0.0.5", 3}, {icd::Status::Unauthorized, "why"}, 0);
  std::map<std::pair<std::string, int>, std::uint64_t> by_uri;
  for (const auto& row : counts.refused_counts()) by_uri[{row.uri, row.status}] = row.count;
  EXPECT_EQ(by_uri.size(), 2);
  EXPECT_EQ((by_uri[{"/map/update", 422}]), TrafficCounts::kMostRefusals + 5);
  EXPECT_EQ((by_uri[{"/state/update", 401}]), 1);
}

TEST(TrafficCounts, CountsRejectedParts) {
  TrafficCounts counts([] {});
  for (const std::size_t parts : {3u, 12u}) {
    counts.count_rejected(icd::Uri::StateUpdate, {"10.0.0.5", 3},
                          {icd::Status::UnprocessableEntity, "poses[1].name: missing", parts}, 0);
  }
  ASSERT_EQ(counts.refused_counts().size(), 1u);
  EXPECT_EQ(counts.refused_counts()[0].count, 2u);
  EXPECT_EQ(counts.refused_counts()[0].parts, 15u);
  EXPECT_EQ(counts.refusals()[0].parts, 12u);
}

TEST(TrafficCounts, KeepsItsAgesAtAClockStep) {
  TrafficCounts counts([] {});
  counts.count_accepted(kCloudOfR1, 1000, 10.0);
  counts.count_rejected(icd::Uri::MapUpdate, {}, {icd::Status::UnprocessableEntity, "bad"}, 11.0);
  counts.move(3600);
  EXPECT_EQ(counts.rows().at(kCloudOfR1).last_accepted, 3610.0);
  EXPECT_FALSE(counts.rows().at(kCloudOfR1).last_forwarded);
  EXPECT_EQ(counts.refusals().front().at, 3611.0);
}

}  // namespace
}  // namespace adit::forward
