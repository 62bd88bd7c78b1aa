// For each posted point, a message with a point of its voxel was delivered, or the point is still to be
// sent.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include "pack/layouts.hpp"
#include "pack/taken_voxels.hpp"

namespace adit::pack {
namespace {

using Cell = std::tuple<int, int, int>;

/// Robots with overlapping clouds, sent two at a time to a Command Post that accepts only some of them.
class Course {
 public:
  explicit Course(std::uint64_t seed) : random_{seed}, layout_{kLayouts[seed % 6]} {}

  void play(int steps) {
    for (int i = 0; i < steps; ++i) {
      if (chance(0.4)) post();
      if (chance(0.5) && under_way_.size() < 2) send();
      if (chance(0.4)) answer(chance(0.6));
      if (chance(0.01)) taken_.forget();
    }
    while (!waiting_.empty() || !under_way_.empty()) {
      if (under_way_.size() < 2) send();
      answer(true);
    }
  }
  const std::map<icd::RobotName, std::set<Cell>>& posted() const { return posted_; }
  const std::map<icd::RobotName, std::set<Cell>>& there() const { return there_; }
  std::size_t left_out() const { return left_out_; }

 private:
  struct Message {
    icd::RobotName robot;
    std::vector<Cell> cells;  // of its points
    Bytes points;
  };
  struct UnderWay {
    Message message;
    TakenVoxels::Rest rest;
  };

  bool chance(double share) { return std::uniform_real_distribution{}(random_) < share; }
  int between(int low, int high) { return std::uniform_int_distribution{low, high}(random_); }

  void post() {
    Message message{*icd::RobotName::parse(chance(0.5) ? "r1" : "r2"), {}, {}};
    const int x = between(-40, 40), count = between(1, 200);
    for (int i = 0; i < count; ++i) {
      const Cell cell{x + between(-8, 8), between(-8, 8), between(-3, 3)};
      const auto within = [&](int at) { return (at + between(1, 9) / 10.0) * kMetres; };
      const Bytes point = point_of(layout_, within(std::get<0>(cell)), within(std::get<1>(cell)),
                                   within(std::get<2>(cell)), static_cast<std::uint8_t>(i));
      message.points.insert(message.points.end(), point.begin(), point.end());
      message.cells.push_back(cell);
      posted_[message.robot].insert(cell);
    }
    waiting_.push_back(std::move(message));
  }
  void send() {
    if (waiting_.empty()) return;
    Message message = std::move(waiting_.front());
    waiting_.pop_front();
    auto rest = taken_.leave_out(message.robot, cloud_of(layout_), cut_up(message.points, random_), kMetres);
    left_out_ += rest.left_out;
    under_way_.push_back({std::move(message), std::move(rest)});
  }
  void answer(bool takes) {
    if (under_way_.empty()) return;
    const UnderWay first = std::move(under_way_.front());
    under_way_.pop_front();
    if (!takes) return waiting_.push_front(first.message);
    taken_.add(first.message.robot, kMetres, first.rest.voxels);
    read(first);
  }
  /// As at the Command Post: the points are a subset of the posted ones, in order.
  void read(const UnderWay& message) {
    const Bytes came = message.rest.data.bytes.to_vector(), &points = message.message.points;
    std::size_t at = 0;
    for (std::size_t i = 0; i * layout_.step < points.size() && at < came.size(); ++i) {
      const auto point = points.begin() + static_cast<std::ptrdiff_t>(i * layout_.step);
      if (!std::equal(point, point + layout_.step, came.begin() + static_cast<std::ptrdiff_t>(at))) continue;
      there_[message.message.robot].insert(message.message.cells[i]);
      at += layout_.step;
    }
    EXPECT_EQ(at, came.size()) << "points that were not posted";
    EXPECT_EQ(came.size(), points.size() - message.rest.left_out * layout_.step);
  }

  static constexpr double kMetres = 0.25;
  std::mt19937_64 random_;
  const Layout& layout_;
  TakenVoxels taken_{48 << 10};  // so small that some voxels are forgotten
  std::deque<Message> waiting_;
  std::deque<UnderWay> under_way_;
  std::map<icd::RobotName, std::set<Cell>> posted_, there_;
  std::size_t left_out_ = 0;
};

class TakenVoxelsLaws : public testing::TestWithParam<std::uint64_t> {};

TEST_P(TakenVoxelsLaws, EachPostedPointHasADeliveredPointOfItsVoxel) {
  Course course{GetParam()};
  course.play(300);
  EXPECT_EQ(course.there(), course.posted());
  EXPECT_GT(course.left_out(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, TakenVoxelsLaws, testing::Range<std::uint64_t>(1, 11));

}  // namespace
}  // namespace adit::pack
