#include <gmock/gmock.h>

#include <random>

#include "queues/maps.hpp"
#include "queues/stamps.hpp"

namespace adit::queues {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

/// The old one began first and is whole last; the new one began and was accepted meanwhile.
const Upload kOld{.address = "10.0.0.5", .began = 1, .ended = 4};
const Upload kNew{.address = "10.0.0.5", .began = 2, .ended = 3, .overlaps = 1};
/// It began after the new one was accepted.
const Upload kLater{.address = "10.0.0.5", .began = 5, .ended = 6};

icd::MapUpdate stamped(icd::MapUpdate map, icd::Stamp stamp) {
  map.header().stamp = stamp;
  return map;
}

icd::MapUpdate grid_at(const char* robot, icd::Stamp stamp) {
  return stamped(grid_update(robot, grid(0, 0, 4, 4)), stamp);
}

TEST(OvertakenMaps, AreOlderAndBeganBeforeTheNewerOneWasAccepted) {
  OvertakenMaps overtaken;
  overtaken.record(grid_at("R1", 10), kNew);
  EXPECT_THAT(overtaken.find_newer(grid_at("R1", 9), kOld), SizeIs(1));
  EXPECT_THAT(overtaken.find_newer(grid_at("R1", 9), kLater), IsEmpty()) << "it began later";
  EXPECT_THAT(overtaken.find_newer(grid_at("R1", 10), kOld), IsEmpty()) << "of the same time";
  EXPECT_THAT(overtaken.find_newer(grid_at("R1", 11), kOld), IsEmpty()) << "newer";
  EXPECT_THAT(overtaken.find_newer(grid_at("R2", 9), kOld), IsEmpty()) << "of another robot";
  Upload other = kOld;
  other.address = "10.0.0.6";
  EXPECT_THAT(overtaken.find_newer(grid_at("R1", 9), other), IsEmpty()) << "of another client";
}

TEST(OvertakenMaps, AreForgottenWithTheUploadsThatTheyOvertook) {
  OvertakenMaps overtaken;
  overtaken.record(grid_at("R1", 10), kNew);
  overtaken.record(grid_at("R2", 10), kOld);  // no other upload is left
  EXPECT_THAT(overtaken.find_newer(grid_at("R1", 9), kOld), IsEmpty());
}

TEST(OvertakenMaps, WaitForThoseThatMayHaveOvertakenThem) {
  OvertakenMaps overtaken;
  overtaken.begin(kNew, false);
  EXPECT_TRUE(overtaken.must_wait(kOld));
  EXPECT_FALSE(overtaken.must_wait(kLater)) << "it began later";
  overtaken.end(kNew);
  EXPECT_FALSE(overtaken.must_wait(kOld));
  overtaken.begin(kOld, true);
  EXPECT_TRUE(overtaken.must_wait(kLater)) << "the overtaken one is queued first";
  overtaken.end(kOld);
  EXPECT_TRUE(overtaken.empty());
}

TEST(OvertakenMaps, AreLimitedForEachClient) {
  OvertakenMaps overtaken;
  for (std::size_t i = 0; i < 2 * OvertakenMaps::kMostOfClient; ++i)
    overtaken.record(grid_at("R1", 10), kNew);
  EXPECT_THAT(overtaken.find_newer(grid_at("R1", 9), kOld), SizeIs(OvertakenMaps::kMostOfClient));
}

std::vector<Cells> outside(const icd::OccupancyGrid& older, std::initializer_list<icd::OccupancyGrid> newer) {
  std::vector<icd::GridBounds> bounds;
  for (const icd::OccupancyGrid& each : newer) bounds.push_back(icd::GridBounds::from_grid(each));
  return cells_outside(older, bounds);
}

TEST(CellsOutside, AreTheStripsAroundTheNewerGrids) {
  const icd::OccupancyGrid older = grid(0, 0, 10, 8, 0.5);
  EXPECT_THAT(outside(older, {grid(-1, -1, 14, 12, 0.5)}), IsEmpty());
  EXPECT_THAT(outside(older, {grid(1, 0, 10, 8, 0.5)}), ElementsAre(Cells{0, 0, 2, 8}));
  EXPECT_THAT(outside(older, {grid(1, 1, 2, 2, 0.5)}),
              ElementsAre(Cells{0, 0, 10, 2}, Cells{0, 4, 10, 4}, Cells{0, 2, 2, 2}, Cells{4, 2, 6, 2}));
  EXPECT_THAT(outside(older, {grid(20, 0, 2, 2, 0.5)}), ElementsAre(Cells{0, 0, 10, 8})) << "apart";
  EXPECT_THAT(outside(older, {grid(0, 0, 20, 20, 0.25)}), ElementsAre(Cells{0, 0, 10, 8}))
      << "of another resolution";
}

/// Each cell is in one rectangle if its middle is in no newer grid, and in none otherwise.
TEST(CellsOutside, AreEachCellOnce) {
  std::mt19937 random(1);
  const auto pick = [&](int from, int to) { return std::uniform_int_distribution(from, to)(random); };
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const double cell = 0.05;
    const icd::OccupancyGrid older =
        grid(0, 0, static_cast<std::uint32_t>(pick(1, 12)), static_cast<std::uint32_t>(pick(1, 12)), cell);
    std::vector<icd::GridBounds> newer;
    for (int i = pick(0, 4); i > 0; --i) {
      newer.push_back(icd::GridBounds::from_grid(grid(cell * pick(-60, 120) / 10, cell * pick(-60, 120) / 10,
                                                      static_cast<std::uint32_t>(pick(1, 9)),
                                                      static_cast<std::uint32_t>(pick(1, 9)), cell)));
    }
    const auto parts = cells_outside(older, newer);
    for (std::int64_t y = 0; y < older.height; ++y) {
      for (std::int64_t x = 0; x < older.width; ++x) {
        const double middle_x = (static_cast<double>(x) + 0.5) * cell,
                     middle_y = (static_cast<double>(y) + 0.5) * cell;
        bool is_covered = false, is_at_an_edge = false;
        for (const icd::GridBounds& each : newer) {
          const double from_x = each.origin.position.x, from_y = each.origin.position.y;
          const auto at = [](double a, double b) { return std::abs(a - b) < 1e-9; };
          is_at_an_edge = is_at_an_edge || at(middle_x, from_x) || at(middle_x, from_x + each.high.x) ||
                          at(middle_y, from_y) || at(middle_y, from_y + each.high.y);
          is_covered = is_covered || (middle_x > from_x && middle_x < from_x + each.high.x &&
                                      middle_y > from_y && middle_y < from_y + each.high.y);
        }
        const auto times =
            std::ranges::count_if(parts, [&](const Cells& part) { return part.holds({x, y, 1, 1}); });
        if (is_at_an_edge) {
          EXPECT_LE(times, 1);
        } else {
          EXPECT_EQ(times, is_covered ? 0 : 1) << x << ", " << y;
        }
      }
    }
  }
}

icd::Marker changed(const char* ns, icd::Stamp stamp, icd::MarkerAction action = icd::MarkerAction::Add) {
  icd::Marker made;
  made.ns = ns;
  made.action = action;
  made.header.stamp = stamp;
  return made;
}

class OvertakenMarkersTest : public testing::Test {
 protected:
  std::vector<std::string> left_of(std::vector<icd::Marker> markers, const Upload& upload = kOld) {
    icd::MarkersUpdate update{.markers = std::move(markers)};
    overtaken_.remove_from(update, upload);
    std::vector<std::string> names;
    for (const icd::Marker& each : update.markers)
      names.push_back(each.action == icd::MarkerAction::DeleteAll ? "all" : each.ns);
    return names;
  }
  OvertakenMarkers overtaken_;
};

TEST_F(OvertakenMarkersTest, AreOlderChangesOfTheSameMarker) {
  overtaken_.record({.markers = {changed("a", 10, icd::MarkerAction::Delete), changed("b", 10)}}, kNew);
  EXPECT_THAT(left_of({changed("a", 9), changed("b", 11), changed("c", 9)}), ElementsAre("b", "c"));
  EXPECT_THAT(left_of({changed("a", 9)}, kLater), ElementsAre("a")) << "it began later";
}

TEST_F(OvertakenMarkersTest, AreAllOlderOnesThanADeleteAll) {
  overtaken_.record({.markers = {changed("", 10, icd::MarkerAction::DeleteAll), changed("b", 10)}}, kNew);
  EXPECT_THAT(left_of({changed("", 9, icd::MarkerAction::DeleteAll), changed("c", 9), changed("d", 11)}),
              ElementsAre("d"));
}

TEST_F(OvertakenMarkersTest, AreAddedAgainBehindAnOlderDeleteAll) {
  overtaken_.record({.markers = {changed("a", 10), changed("b", 8)}}, kNew);
  EXPECT_THAT(left_of({changed("", 9, icd::MarkerAction::DeleteAll), changed("c", 9)}),
              ElementsAre("all", "c", "a"));
}

TEST_F(OvertakenMarkersTest, AreNotAddedAgainIfAnotherClientReplacedThem) {
  const Upload other{.address = "10.0.0.6", .began = 3, .ended = 4};
  overtaken_.record({.markers = {changed("a", 10), changed("b", 10)}}, kNew);
  overtaken_.record({.markers = {changed("a", 5)}}, other);
  EXPECT_THAT(left_of({changed("", 9, icd::MarkerAction::DeleteAll)}), ElementsAre("all", "b"));
  overtaken_.record({.markers = {changed("", 5, icd::MarkerAction::DeleteAll)}}, other);
  EXPECT_THAT(left_of({changed("", 9, icd::MarkerAction::DeleteAll)}), ElementsAre("all"));
}

TEST_F(OvertakenMarkersTest, AreNotKnownBeyondTheLimit) {
  icd::Marker large = changed("a", 10);
  large.points.resize(icd::kMostMarkerPoints);
  overtaken_.record({.markers = {large}}, kNew);
  EXPECT_THAT(left_of({changed("a", 9)}), ElementsAre("a"));
}

}  // namespace
}  // namespace adit::queues
