#include "forward/map_picture.hpp"

#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "forward/sample_maps.hpp"
#include "loop/turn_until.hpp"
#include "picture/maps.hpp"

namespace adit::forward {
namespace {

using picture::TileIndex;

class MapPictureTest : public testing::Test {
 protected:
  bool drawn(const char* robot, const TileIndex& at,
             picture::LayerKind kind = picture::LayerKind::Grid) const {
    return picture.mosaic().tile({robot, kind}, at, {}).tile != nullptr;
  }

  loop::Loop loop;
  loop::Workers workers{loop, 1};
  int changes = 0;
  MapPicture picture{loop, workers, [this] { ++changes; }};
};

TEST_F(MapPictureTest, DrawsEachDeliveredMap) {
  picture.on_forwarded(grid_of("r1", 4, 0));
  picture.on_forwarded(grid_of("r2", 4, 0, 64));
  picture.on_forwarded(cloud_along_x("r1", {0, 0, 0}));
  ASSERT_TRUE(loop::turn_until(loop, [&] { return drawn("r1", {0, 0, 0}, picture::LayerKind::Cloud); }))
      << "the last map";
  EXPECT_TRUE(drawn("r1", {0, 0, 0}));
  EXPECT_TRUE(drawn("r2", {0, 1, 0}));
  EXPECT_EQ(changes, 3);
  picture.on_forwarded(grid_of("r1", 4, 0));
  picture.on_forwarded(grid_of("r3", 4, 0));
  ASSERT_TRUE(loop::turn_until(loop, [&] { return drawn("r3", {0, 0, 0}); }));
  EXPECT_EQ(changes, 4) << "an equal grid changes nothing";
}

TEST_F(MapPictureTest, FreesNoMapOnTheLoop) {
  const std::vector<std::uint8_t> cells(16, 0);
  std::atomic<std::thread::id> freed_by;
  icd::MapUpdate map = grid_of("r1", 4, 0);
  map.data.bytes = {};
  map.data.bytes.append(
      std::shared_ptr<const void>(cells.data(), [&](const void*) { freed_by = std::this_thread::get_id(); }),
      cells);
  picture.on_forwarded(std::move(map));
  ASSERT_TRUE(loop::turn_until(loop, [&] { return drawn("r1", {0, 0, 0}); }));
  EXPECT_NE(freed_by.load(), std::thread::id());
  EXPECT_NE(freed_by.load(), std::this_thread::get_id());
}

/// CPU time of the only worker.
class WorkerTime {
 public:
  WorkerTime(loop::Loop& loop, loop::Workers& workers) {
    bool is_known = false;
    workers.submit(
        loop::Urgency::OnTheWay, [this] { pthread_getcpuclockid(pthread_self(), &clock_); },
        [&] { is_known = true; });
    EXPECT_TRUE(loop::turn_until(loop, [&] { return is_known; }));
  }
  std::chrono::nanoseconds used() const {
    timespec used{};
    clock_gettime(clock_, &used);
    return std::chrono::seconds{used.tv_sec} + std::chrono::nanoseconds{used.tv_nsec};
  }

 private:
  clockid_t clock_{};
};

/// If the drawing ends too early, the test tries again.
TEST_F(MapPictureTest, GivesWayToMapsForTheCommandPost) {
  const WorkerTime time(loop, workers);
  const icd::MapUpdate large = grid_of("r1", 1, 0);
  const std::vector<std::uint8_t> cells(std::size_t{5000} * 5000, 0);
  bool amid = false;
  for (int attempt = 0; attempt < 50 && !amid; ++attempt) {
    std::atomic<bool> freed = false;
    bool packed = false;
    icd::MapUpdate map = large;
    auto& its_grid = std::get<icd::OccupancyGrid>(map.msg);
    its_grid.width = its_grid.height = 5000;
    map.data = {{}, icd::Compression::None, cells.size()};
    map.data.bytes.append(std::shared_ptr<const void>(cells.data(), [&](const void*) { freed = true; }),
                          cells);
    const auto before = time.used();
    picture.on_forwarded(std::move(map));
    ASSERT_TRUE(loop::turn_until(loop, [&] {
      return freed || time.used() - before > loop::JobQueue<int>::kTurn + std::chrono::milliseconds{5};
    }));
    workers.submit(loop::Urgency::OnTheWay, [&] { amid = !freed; }, [&] { packed = true; });
    ASSERT_TRUE(loop::turn_until(loop, [&] { return packed && freed; }));
  }
  EXPECT_TRUE(amid);
}

TEST_F(MapPictureTest, SkipsAQueuedGridThatTheNextOneCovers) {
  picture.on_forwarded(grid_of("r1", 4, 0));
  picture.on_forwarded(grid_of("r2", 4, 0, 64));
  picture.on_forwarded(grid_of("r1", 5, 100));
  ASSERT_TRUE(loop::turn_until(loop, [&] { return drawn("r1", {0, 0, 0}); }));
  EXPECT_TRUE(drawn("r2", {0, 1, 0}));
  EXPECT_EQ(changes, 2);
}

TEST_F(MapPictureTest, DrawsWhatACreepingWindowLeavesBehind) {
  const auto window = [](double x, std::uint8_t value) { return grid_of("r1", 4, value, x); };
  picture.on_forwarded(window(0, 0));
  picture.on_forwarded(window(0.12, 10));
  picture.on_forwarded(window(0.24, 100));
  ASSERT_TRUE(loop::turn_until(loop, [&] { return changes == 2; }))
      << "one was skipped, 0.24 m are left behind";
}

TEST_F(MapPictureTest, DrawsCloudsAndUncoveredGrids) {
  picture.on_forwarded(grid_of("r1", 4, 0));
  picture.on_forwarded(grid_of("r1", 4, 0, 64));
  picture.on_forwarded(cloud_along_x("r1", {0, 0, 0}));
  picture.on_forwarded(cloud_along_x("r2", {0, 0, 0}));
  ASSERT_TRUE(loop::turn_until(loop, [&] { return drawn("r2", {0, 0, 0}, picture::LayerKind::Cloud); }));
  EXPECT_TRUE(drawn("r1", {0, 0, 0}));
  EXPECT_TRUE(drawn("r1", {0, 1, 0}));
  EXPECT_TRUE(drawn("r1", {0, 0, 0}, picture::LayerKind::Cloud));
}

TEST_F(MapPictureTest, CountsMapsThatItsQueueCannotHold) {
  auto large = cloud_along_x("r1", {});
  const icd::ChunkedBytes piece{std::vector<std::uint8_t>(60'000)};
  while (large.data.bytes.size() < MapPicture::kMostWaiting / 2) large.data.bytes.append(piece);
  large.data.raw_size = large.data.bytes.size();
  for (int i = 0; i < 3; ++i) picture.on_forwarded(large);
  const auto layers = picture.mosaic().layers();
  ASSERT_EQ(layers.size(), 1U);
  EXPECT_EQ(layers[0].missed, 2U) << "only one fits";
  EXPECT_TRUE(loop::turn_until(loop, [&] { return drawn("r1", {0, 0, 0}, picture::LayerKind::Cloud); }));
}

TEST_F(MapPictureTest, CountsAMapThatCannotBeDrawn) {
  auto damaged = grid_of("r1", 4, 0);
  damaged.data.compression = icd::Compression::Gzip;
  picture.on_forwarded(damaged);
  ASSERT_TRUE(loop::turn_until(loop, [&] { return !picture.mosaic().layers().empty(); }));
  EXPECT_EQ(picture.mosaic().layers()[0].missed, 1U);
  picture.on_forwarded(grid_of("r1", 4, 0));
  EXPECT_TRUE(loop::turn_until(loop, [&] { return drawn("r1", {0, 0, 0}); })) << "later maps are drawn";
}

TEST_F(MapPictureTest, IsEmptyInANewRun) {
  picture.on_forwarded(grid_of("r1", 4, 0));
  ASSERT_TRUE(loop::turn_until(loop, [&] { return drawn("r1", {0, 0, 0}); }));
  picture.on_forwarded(grid_of("r2", 4, 0));
  changes = 0;
  picture.begin_run();
  EXPECT_EQ(changes, 1);
  EXPECT_FALSE(drawn("r1", {0, 0, 0}));
  loop::turn_for(loop, std::chrono::milliseconds{100});
  EXPECT_FALSE(drawn("r2", {0, 0, 0}));

  picture.on_forwarded(grid_of("r3", 1000, 0));
  loop.turn(std::chrono::milliseconds{5});  // passed to the worker
  picture.begin_run();
  picture.on_forwarded(grid_of("r4", 4, 0));
  ASSERT_TRUE(loop::turn_until(loop, [&] { return drawn("r4", {0, 0, 0}); }));
  EXPECT_FALSE(drawn("r3", {0, 0, 0}));
}

class CoveredCountTest : public testing::Test {
 protected:
  void ask() {
    count.count([this](const auto& covered) { answers.push_back(covered ? covered->all : 0); });
  }
  void draw(double x) { easel.draw(picture::grid_at(x, 0, 2, 0.25, picture::Cells(4, 0))); }
  /// Waits for that many answers.
  bool answered(std::size_t wanted) {
    return loop::turn_until(loop, [&] { return answers.size() == wanted; });
  }

  loop::Loop loop;
  loop::Workers workers{loop, 1};
  picture::Easel easel;
  CoveredCount count{workers, easel.mosaic};
  std::vector<std::uint64_t> answers;  // pixels; 0: an error
};

TEST_F(CoveredCountTest, AnswersWithThePresentMap) {
  draw(0);
  ask();
  draw(10);
  ask();  // during the first count
  ASSERT_TRUE(answered(2));
  EXPECT_EQ(answers, (std::vector<std::uint64_t>{4, 8}));
}

TEST_F(CoveredCountTest, RejectsRequestsBeyondTheLimit) {
  draw(0);
  for (std::size_t i = 0; i < CoveredCount::kMostAskers + 2; ++i) ask();
  EXPECT_EQ(answers, std::vector<std::uint64_t>{0}) << "only the last request is rejected";
  ASSERT_TRUE(answered(CoveredCount::kMostAskers + 2));
  EXPECT_EQ(answers.back(), 4);
}

}  // namespace
}  // namespace adit::forward
