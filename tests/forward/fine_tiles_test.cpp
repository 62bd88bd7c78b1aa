#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "forward/map_picture.hpp"
#include "forward/sample_maps.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

using picture::TileIndex;

icd::MapUpdate grid(const std::string& robot, double x, std::uint32_t side, std::uint8_t value) {
  return grid_of(robot, side, value, x, 0.05);
}

class FineTilesTest : public testing::Test {
 protected:
  using Answer = std::optional<icd::Checked<picture::Tile>>;

  std::shared_ptr<Answer> asked(const std::string& robot, const TileIndex& at) {
    auto answer = std::make_shared<Answer>();
    picture.fine_map().tile({robot, picture::LayerKind::Grid}, at,
                            [answer](auto tile) { *answer = std::move(tile); });
    return answer;
  }
  /// Null: no tile.
  picture::Tile tile(const std::string& robot, const TileIndex& at) {
    const auto answer = asked(robot, at);
    EXPECT_TRUE(loop::turn_until(loop, [&] { return answer->has_value(); }));
    EXPECT_TRUE(*answer && **answer);
    return *answer && **answer ? ***answer : nullptr;
  }
  /// Colour of the lower left pixel; -1: no tile.
  int index(const std::string& robot, const TileIndex& at) {
    const auto its = tile(robot, at);
    if (its == nullptr) return -1;
    picture::Pixels pixels{};
    picture::Packer{}.unpack(*its, pixels);
    return pixels[picture::index_of(0, 0)];
  }
  std::optional<picture::FinerLevels> finer(const std::string& robot, std::uint64_t since = 0) {
    return picture.fine_map().finer_levels({robot, picture::LayerKind::Grid}, since);
  }
  void forward(const icd::MapUpdate& map) {
    const int before = changes;
    picture.on_forwarded(map);
    ASSERT_TRUE(loop::turn_until(loop, [&] { return changes > before; }));
  }

  loop::Loop loop;
  loop::Workers workers{loop, 1};
  int changes = 0;
  MapPicture picture{loop, workers, [this] { ++changes; }};
};

TEST_F(FineTilesTest, ShowTheLatestDeliveredGrid) {
  EXPECT_EQ(tile("r1", {-1, 0, 0}), nullptr);
  forward(grid("r1", 0, 400, 0));
  ASSERT_TRUE(finer("r1"));
  EXPECT_EQ(finer("r1")->level, -1);
  EXPECT_EQ(index("r1", {-1, 0, 0}), 1);
  EXPECT_EQ(index("r1", {-1, 1, 1}), 1);
  EXPECT_EQ(tile("r1", {-1, 2, 0}), nullptr);
  EXPECT_EQ(tile("r2", {-1, 0, 0}), nullptr);
  EXPECT_EQ(tile("r1", {-2, 0, 0}), nullptr) << "finer than its cells";
  forward(grid("r1", 0, 400, 100));
  EXPECT_EQ(index("r1", {-1, 0, 0}), 101);
}

TEST_F(FineTilesTest, HaveAVersionForFineChanges) {
  std::vector<std::uint8_t> cells(400, 0);
  cells[0] = 100;
  icd::MapUpdate one = grid("r1", 0, 20, 0), other = one;
  one.data.bytes = icd::ChunkedBytes{cells};
  std::swap(cells[0], cells[1]);
  other.data.bytes = icd::ChunkedBytes{cells};
  forward(one);
  const auto before = picture.mosaic().version();
  EXPECT_FALSE(finer("r1", before)->area);
  forward(other);
  EXPECT_GT(picture.mosaic().version(), before);
  EXPECT_EQ(*finer("r1", before)->area, (picture::Area{0, 0, 1, 1}));
  EXPECT_FALSE(finer("r1", picture.mosaic().version())->area) << "no newer change";
}

TEST_F(FineTilesTest, AreRedrawnOnlyAfterAGridInTheirBlock) {
  forward(grid("r1", 0, 2000, 0));
  const auto first = tile("r1", {-1, 0, 0});
  EXPECT_EQ(tile("r1", {-1, 0, 0}), first) << "cached";
  forward(grid("r1", 200, 20, 0));
  EXPECT_EQ(tile("r1", {-1, 0, 0}), first) << "the grid is in another block";
  EXPECT_EQ(index("r1", {-1, 4, 4}), 1);
  forward(grid("r1", 10, 20, 100));
  const auto again = tile("r1", {-1, 0, 0});
  EXPECT_NE(again, first);
}

TEST_F(FineTilesTest, IncludeAGridThatArrivesDuringADrawing) {
  forward(grid("r1", 0, 2000, 0));
  const auto before = asked("r1", {-1, 0, 0});
  EXPECT_FALSE(before->has_value());
  forward(grid("r1", 0, 2000, 100));  // drawn after the tile
  EXPECT_EQ(index("r1", {-1, 0, 0}), 101);
  EXPECT_TRUE(before->has_value());
}

TEST_F(FineTilesTest, AreNoneInANewRun) {
  forward(grid("r1", 0, 400, 0));
  EXPECT_EQ(index("r1", {-1, 0, 0}), 1);
  picture.begin_run();
  EXPECT_FALSE(finer("r1"));
  EXPECT_EQ(tile("r1", {-1, 0, 0}), nullptr);
}

TEST_F(FineTilesTest, YieldToMapsForTheCommandPost) {
  forward(grid("r1", 0, 5000, 0));
  std::vector<std::shared_ptr<Answer>> answers;
  for (int x = 0; x < 4; ++x) answers.push_back(asked("r1", {-1, x * 5, 0}));
  bool is_packed = false;
  workers.submit(loop::Urgency::OnTheWay, [] {}, [&] { is_packed = true; });
  ASSERT_TRUE(loop::turn_until(loop, [&] { return is_packed; }));
  EXPECT_FALSE(answers.back()->has_value());
  EXPECT_TRUE(loop::turn_until(loop, [&] { return answers.back()->has_value(); }));
}

TEST_F(FineTilesTest, StayWithinTheirBudget) {
  for (int robot = 0; robot < 20; ++robot) {
    for (int part = 0; part < 3; ++part) forward(grid("r" + std::to_string(robot), part * 64.0, 1280, 0));
  }
  for (int robot = 0; robot < 20; ++robot) {
    for (int part = 0; part < 3; ++part) {
      ASSERT_EQ(index("r" + std::to_string(robot), {-1, part * 5, 0}), 1) << robot << ", " << part;
      ASSERT_LE(picture.finer_bytes(), FineTiles::kMostDrawn + picture::ForwardedGrids::kBudget);
    }
  }
}

TEST_F(FineTilesTest, LimitPendingRequests) {
  forward(grid("r1", 0, 5000, 0));
  std::vector<std::shared_ptr<Answer>> answers;
  for (std::size_t i = 0; i < FineTiles::kMostAskers + 2; ++i) {
    answers.push_back(asked("r1", {-1, static_cast<int>(i % 19), static_cast<int>(i / 19 % 19)}));
  }
  ASSERT_TRUE(answers.back()->has_value());
  ASSERT_FALSE(**answers.back());
  EXPECT_EQ((**answers.back()).error().status, icd::Status::ServiceUnavailable);
  EXPECT_TRUE(loop::turn_until(loop, [&] { return answers.front()->has_value(); }));
  EXPECT_TRUE(loop::turn_until(loop, [&] { return answers[FineTiles::kMostAskers]->has_value(); }));
}

}  // namespace
}  // namespace adit::forward
