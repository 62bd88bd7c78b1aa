// The precision of a robot's clouds: by its setting, or by the queued bytes.
#include <gtest/gtest.h>

#include "queues/clouds.hpp"
#include "queues/map_queue.hpp"
#include "queues/maps.hpp"

namespace adit::queues {
namespace {

constexpr std::size_t kMergeRoom = 1 << 20;

TEST(PrecisionFor, IsTheFinestThatFitsOneMessage) {
  constexpr PointsAt kHolds{100, 150, 200};
  const std::pair<std::size_t, Precision> rows[] = {{0, Precision::Exact},
                                                    {100, Precision::Exact},
                                                    {101, Precision::Millimetre},
                                                    {150, Precision::Millimetre},
                                                    {151, Precision::EightMillimetres},
                                                    {201, Precision::EightMillimetres},
                                                    {SIZE_MAX, Precision::EightMillimetres}};
  for (const auto& [waiting, precision] : rows)
    EXPECT_EQ(precision_for(waiting, kHolds), precision) << waiting;
}

class PrecisionOf : public testing::Test {
 protected:
  PrecisionOf() {
    queue_.set_precisions({{*robot("R1"), Precision::Auto}, {*robot("R2"), Precision::Millimetre}});
  }
  void add(const char* name, int clouds) {
    for (int i = 0; i < clouds; ++i) queue_.add(++number_, cloud_update(name, {1, 2, 3}), at(i));
  }
  Precision next() { return queue_.pop()->precision; }

  MapQueue queue_{kMergeRoom};
  std::uint64_t number_ = 0;
};

TEST_F(PrecisionOf, ARobotIsItsSetting) {
  queue_.set_message_points({1, 1, 1});
  add("R2", 3);
  EXPECT_EQ(next(), Precision::Millimetre);
  add("R3", 3);
  while (queue_.count(Sender{robot("R2"), false}) > 0) (void)queue_.pop();
  EXPECT_EQ(next(), Precision::Exact) << "a robot without a setting";
}

TEST_F(PrecisionOf, CloudsOfNoRobotAndGridsIsExact) {
  queue_.set_message_points({1, 1, 1});
  add("", 1);
  EXPECT_EQ(next(), Precision::Exact);
  queue_.add(++number_, grid_update("R2", grid(0, 0, 2, 2)), at(1));
  EXPECT_EQ(next(), Precision::Exact);
}

TEST_F(PrecisionOf, AutoFollowsTheQueuedBytes) {
  add("R1", 1);
  const std::size_t one = queue_.bytes();
  queue_.set_message_points({one, 2 * one, 3 * one});
  EXPECT_EQ(next(), Precision::Exact);
  add("R1", 2);
  EXPECT_EQ(next(), Precision::Millimetre);
  add("R1", 4);
  EXPECT_EQ(next(), Precision::EightMillimetres);
  while (queue_.count() > 0) (void)queue_.pop();
  add("R1", 1);
  EXPECT_EQ(next(), Precision::Exact) << "once the queue is empty";
}

TEST_F(PrecisionOf, AutoMergesAtMostOneMessage) {
  add("R1", 1);
  const std::size_t points = queue_.pop()->map.data.raw_size;
  queue_.set_message_points({points, 2 * points, 3 * points});
  add("R1", 9);
  const auto taken = queue_.pop();
  EXPECT_EQ(taken->precision, Precision::EightMillimetres);
  EXPECT_EQ(taken->map.data.raw_size, 3 * points);
}

TEST_F(PrecisionOf, ARetriedCloudIsChosenAnew) {
  add("R1", 1);
  queue_.set_message_points({1, 1, 1});
  auto back = *queue_.pop();
  EXPECT_EQ(back.precision, Precision::EightMillimetres);
  queue_.set_message_points(kAnyPoints);
  (void)queue_.put_back(std::move(back));
  EXPECT_EQ(next(), Precision::Exact);
}

}  // namespace
}  // namespace adit::queues
