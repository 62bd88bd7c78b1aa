#include "forward/record.hpp"

#include <gtest/gtest.h>

namespace adit::forward {
namespace {

const Traffic kCloudOfR1{Kind::Cloud, "r1"};

TEST(Record, CountsTheMapsOfEachRobot) {
  int changes = 0;
  Record record([&] { ++changes; });
  record.accepted(kCloudOfR1, 1000, 10.0);
  record.accepted(kCloudOfR1, 1100, 11.0);
  record.rounded_to(kCloudOfR1, queues::Precision::EightMillimetres);
  record.forwarded(kCloudOfR1, 2, 900, 200, 12.0);
  record.accepted({Kind::Grid, "r1"}, 5, 13.0);
  record.not_taken({Kind::Grid, "r1"}, DeliveryFailure::Throttled, 429, "too frequent");

  ASSERT_EQ(record.rows().size(), 2u);
  const api::ActivityRow &grid = record.rows().at({Kind::Grid, "r1"}), &cloud = record.rows().at(kCloudOfR1);
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

TEST(Record, ClearsTheSentenceOnceAMessageIsDelivered) {
  Record record([] {});
  record.not_taken(kCloudOfR1, DeliveryFailure::Failed, 0, "connection reset");
  record.forwarded(kCloudOfR1, 1, 10, 200, 1.0);
  EXPECT_EQ(record.rows().at(kCloudOfR1).last_sentence, "");
  EXPECT_EQ(record.rows().at(kCloudOfR1).failed, 1u);
}

TEST(Record, CountsRobotsBeyondTheLastRowTogether) {
  Record record([] {});
  for (std::size_t i = 0; i < 2 * Record::kMostRows; ++i)
    record.accepted({Kind::State, std::to_string(i)}, 1, 0.0);
  const auto& rows = record.rows();
  EXPECT_LE(rows.size(), Record::kMostRows + 1);
  std::uint64_t accepted = 0;
  for (const auto& [traffic, row] : rows) accepted += row.accepted;
  EXPECT_EQ(accepted, 2 * Record::kMostRows);
}

TEST(Record, HasTheTimeOfTheLastFullQueue) {
  Record record([] {});
  record.no_room(kCloudOfR1, 10);
  record.no_room({Kind::Markers, ""}, 20);
  record.no_room({Kind::Markers, ""}, 21);
  EXPECT_EQ(record.rows().at({Kind::Markers, ""}).no_room, 2u);
  EXPECT_EQ(record.rows().at({Kind::Markers, ""}).last_no_room, 21);
  EXPECT_EQ(record.rows().at(kCloudOfR1).last_no_room, 10);
}

TEST(Record, KeepsTheLastRejectionsNewestFirst) {
  Record record([] {});
  for (std::size_t i = 0; i < Record::kMostRefusals + 5; ++i) {
    record.refused(icd::Uri::MapUpdate, {"10.0.0.5", 3},
                   {icd::Status::UnprocessableEntity, std::to_string(i)}, double(i));
  }
  const auto rows = record.refusals();
  ASSERT_EQ(rows.size(), Record::kMostRefusals);
  EXPECT_EQ(rows.front().sentence, std::to_string(Record::kMostRefusals + 4));
  EXPECT_EQ(rows.front().uri, "/map/update");
  EXPECT_EQ(rows.front().sender, "10.0.0.5");
  EXPECT_EQ(rows.front().status, 422);
}

TEST(Record, CountsRejectionsByUriAndStatus) {
  Record record([] {});
  for (std::size_t i = 0; i < Record::kMostRefusals + 5; ++i) {
    record.refused(icd::Uri::MapUpdate, {"10.0.0.5", 3}, {icd::Status::UnprocessableEntity, "why"}, 0);
  }
  record.refused(icd::Uri::StateUpdate, {"10.0.0.5", 3}, {icd::Status::Unauthorized, "why"}, 0);
  std::map<std::pair<std::string, int>, std::uint64_t> counts;
  for (const auto& row : record.refused_counts()) counts[{row.uri, row.status}] = row.count;
  EXPECT_EQ(counts.size(), 2);
  EXPECT_EQ((counts[{"/map/update", 422}]), Record::kMostRefusals + 5);
  EXPECT_EQ((counts[{"/state/update", 401}]), 1);
}

TEST(Record, CountsRejectedParts) {
  Record record([] {});
  for (const std::size_t parts : {3u, 12u}) {
    record.refused(icd::Uri::StateUpdate, {"10.0.0.5", 3},
                   {icd::Status::UnprocessableEntity, "poses[1].name: missing", parts}, 0);
  }
  ASSERT_EQ(record.refused_counts().size(), 1u);
  EXPECT_EQ(record.refused_counts()[0].count, 2u);
  EXPECT_EQ(record.refused_counts()[0].parts, 15u);
  EXPECT_EQ(record.refusals()[0].parts, 12u);
}

TEST(Record, KeepsItsAgesAtAClockStep) {
  Record record([] {});
  record.accepted(kCloudOfR1, 1000, 10.0);
  record.refused(icd::Uri::MapUpdate, {}, {icd::Status::UnprocessableEntity, "bad"}, 11.0);
  record.move(3600);
  EXPECT_EQ(record.rows().at(kCloudOfR1).last_accepted, 3610.0);
  EXPECT_FALSE(record.rows().at(kCloudOfR1).last_forwarded);
  EXPECT_EQ(record.refusals().front().at, 3611.0);
}

}  // namespace
}  // namespace adit::forward
