#include <gmock/gmock.h>

#include <functional>

#include "simulation/checks.hpp"
#include "simulation/map_messages.hpp"
#include "simulation/messages.hpp"
#include "simulation/scoreboard.hpp"

namespace adit::simulation {
namespace {

constexpr int kGap = 255;

/// What team and Command Post saw of one robot's grids.
class ChecksGridsTest : public testing::Test {
 protected:
  struct Grid {
    std::int64_t serial;
    Extent extent;

    int value(int x, int y) const { return value_of(serial, x, y); }
    bool has(int x, int y) const {
      return x >= extent.x && x < extent.x + 2 * extent.width && y >= extent.y &&
             y < extent.y + 2 * extent.height;
    }
  };

  void post(const Grid& grid) {
    ++request_;
    add(Actor::Team, Kind::Invoke, grid.extent).serial = grid.serial;
    add(Actor::Team, Kind::Answered, grid.extent).status = 200;
  }

  /// As one message, with gaps where none of them is.
  void taken(const Extent& extent, const std::vector<Grid>& grids) {
    Says& says = add(Actor::Post, Kind::Taken, extent).says;
    for (int y = extent.y; y < extent.y + 2 * extent.height; y += 2) {
      for (int x = extent.x; x < extent.x + 2 * extent.width; x += 2) {
        int value = kGap;
        for (const Grid& grid : grids) value = grid.has(x, y) ? grid.value(x, y) : value;
        says.push_back(value);
      }
    }
  }
  void begin_run(const char* what) {
    Event& event = add(Actor::Post, Kind::NewRun, {});
    event.what = what;
    event.says.clear();
  }
  /// All of it is known, and then two corners are taken in one message with nothing between them, twice.
  void know_and_blank(const std::function<void()>& between) {
    post(all_);
    taken(all_);
    between();
    for (int i = 0; i < 2; ++i) {
      post({low_.serial + 10 * i, low_.extent});
      post({high_.serial + 10 * i, high_.extent});
      taken(all_.extent, {{low_.serial + 10 * i, low_.extent}, {high_.serial + 10 * i, high_.extent}});
    }
  }
  void taken(const Grid& grid) { taken(grid.extent, {grid}); }

  Broken broken() const {
    Broken found;
    grid_arrived({.events = events_, .reports = {}, .readings = {}}, found);
    return found;
  }

  /// A grid of 8 by 8 cells, one of which at least has the value of a gap.
  static Grid with_value_of_a_gap() {
    for (Grid grid{1, {50, 0, 0, 8, 8}};; ++grid.serial) {
      for (int cell = 0; cell < 64; ++cell) {
        if (grid.value(cell % 8 * 2, cell / 8 * 2) == kGap) return grid;
      }
    }
  }

  const Grid replaced_ = with_value_of_a_gap(), over_it_{1001, {50, 1, 12, 12, 4}},
             low_{1002, {50, -12, -12, 4, 4}}, high_{1003, {50, 20, 20, 4, 4}},
             newest_{1004, {50, 0, 0, 9, 9}}, all_{1005, {50, -12, -12, 20, 20}};

 private:
  Event& add(Actor actor, Kind kind, const Extent& extent) {
    Event& event = events_.emplace_back();
    event.at = static_cast<double>(events_.size());
    event.actor = actor;
    event.kind = kind;
    event.what = kMap;
    event.who = "R1";
    event.request = actor == Actor::Team ? request_ : 0;
    event.says = extent.says();
    return event;
  }

  std::vector<Event> events_;
  std::uint64_t request_ = 0;
};

TEST_F(ChecksGridsTest, AGapIsNotWhatLiesThereByChance) {
  for (const Grid& grid : {replaced_, over_it_, low_, high_, newest_}) post(grid);
  taken(over_it_);
  taken({50, -12, -12, 20, 20}, {low_, high_});
  taken(newest_);
  EXPECT_THAT(broken(), testing::IsEmpty());
}

TEST_F(ChecksGridsTest, AnOlderGridAmongGapsIsInTheMessage) {
  for (const Grid& grid : {replaced_, over_it_, low_, high_, newest_}) post(grid);
  taken(over_it_);
  taken({50, -12, -12, 20, 20}, {replaced_, low_, high_});
  taken(newest_);
  EXPECT_THAT(broken(), testing::ElementsAre(testing::HasSubstr("lies over its newer 1001")));
}

TEST_F(ChecksGridsTest, ACellThatIsKnownBecomesNotUnknown) {
  know_and_blank([] {});
  EXPECT_THAT(broken(), testing::Each(testing::HasSubstr("cells that nobody posted")));
  EXPECT_THAT(broken(), testing::SizeIs(2));
}

TEST_F(ChecksGridsTest, ACellThatIsKnownBecomesNotUnknownWhereOneMoreReportWasGranted) {
  know_and_blank([this] { begin_run(kSameMap); });
  EXPECT_THAT(broken(), testing::SizeIs(2));
}

TEST_F(ChecksGridsTest, ACellThatWasKnownInAnEarlierRunMayBeUnknown) {
  know_and_blank([this] { begin_run(""); });
  EXPECT_THAT(broken(), testing::IsEmpty());
}

}  // namespace
}  // namespace adit::simulation
