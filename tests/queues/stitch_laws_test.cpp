// The Command Post finally has the posted cells, whatever grids were stitched.
#include <gmock/gmock.h>

#include <map>
#include <random>
#include <set>
#include <string>
#include <tuple>

#include "queues/lattice.hpp"
#include "queues/map_queue.hpp"
#include "queues/maps.hpp"
#include "queues/packing.hpp"

namespace adit::queues {
namespace {

/// Name and lattice of a grid. The lattice is that of a grid kept for it.
using Place = std::tuple<std::string, int, std::int64_t, std::int64_t>;

/// The cells of a server.
class Replay {
 public:
  explicit Replay(bool overlays) : overlays_(overlays) {}
  void put(const Place& place, std::uint8_t value) {
    if (overlays_ && value == icd::kUnknownCell) return;
    cells[place] = value;
  }
  std::map<Place, std::uint8_t> cells;

 private:
  bool overlays_;
};

class StitchLaws : public testing::TestWithParam<std::uint64_t> {
 protected:
  static icd::OccupancyGrid lattice(int which) {
    return which == 0   ? grid(0, 0, 1, 1, 0.05)
           : which == 1 ? grid(0.025, 0, 1, 1, 0.05)
                        : grid(0, 0, 1, 1, 0.1);
  }

  /// Visits each cell of a grid, in order.
  template <class Visit>
  static void for_each_cell(const icd::MapUpdate& map, Visit visit) {
    const auto& grid = std::get<icd::OccupancyGrid>(map.msg);
    const std::string name = map.name ? map.name->text() : "";
    for (int which = 0; which < 3; ++which) {
      const auto cells = cells_in(lattice(which), grid);
      if (!cells) continue;
      for (std::int64_t y = cells->y; y < cells->top(); ++y) {
        for (std::int64_t x = cells->x; x < cells->right(); ++x) visit(Place{name, which, x, y});
      }
    }
  }

  void run() {
    for (int step = 0; step < 300; ++step) {
      const int what = pick(10);
      if (what < 6) post();
      if (what >= 6) send(what);
    }
    while (queue_.count() > 0) send(9);
  }

  /// A grid of one of the first two lattices, half a cell apart, may replace cells of the other.
  void forget_covered(const icd::MapUpdate& map, int which) {
    if (which > 1) return;
    const auto grid = *cells_in(lattice(which), std::get<icd::OccupancyGrid>(map.msg));
    const std::string name = map.name ? map.name->text() : "";
    std::erase_if(newest_, [&](const auto& posted) {
      const auto& [its_name, its_lattice, x, y] = posted.first;
      if (its_name != name || its_lattice != 1 - which) return false;
      const std::int64_t left = 2 * x + its_lattice, from = 2 * grid.x + which;  // in half cells
      return left >= from - 1 && left + 2 <= from + 2 * grid.width + 1 && y >= grid.y && y < grid.top();
    });
  }

  void post() {
    const int which = pick(8) == 0 ? pick(3) : 0;
    auto origin = lattice(which);
    origin.width = static_cast<std::uint32_t>(1 + pick(5));
    origin.height = static_cast<std::uint32_t>(1 + pick(5));
    origin.origin = *corner_at(origin, pick(12) - 6, pick(12) - 6);
    icd::MapUpdate map = grid_update(pick(4) == 0 ? "" : "R1", origin);
    std::vector<std::uint8_t> values(map.data.raw_size);
    for (auto& value : values)
      value = pick(4) == 0 ? icd::kUnknownCell : static_cast<std::uint8_t>(pick(101));
    map.data.bytes = icd::ChunkedBytes{values};
    forget_covered(map, which);
    auto value = values.begin();
    for_each_cell(map, [&](const Place& place) {
      newest_[place] = *value;
      posted_[place].insert(*value++);
    });
    ++number_;
    queue_.add(number_, std::move(map), at(static_cast<double>(number_)));
  }

  /// Sends as a gateway does: other grids arrive meanwhile, and the message may be lost or rejected.
  void send(int how) {
    auto next = queue_.pop();
    if (!next) return;
    const auto cells = packed_of(queue_, *next);
    while (pick(3) == 0) post();
    if (how == 6) {
      queue_.put_back(std::move(*next));
    } else if (how == 7 && !next->parts.empty()) {
      queue_.put_back_single(std::move(*next));
    } else {
      deliver(*next, cells);
    }
  }

  void deliver(const QueuedMap& sent, const std::vector<std::uint8_t>& cells) {
    auto value = cells.begin();
    for_each_cell(sent.map, [&](const Place& place) {
      overwriting_.put(place, *value);
      overlaying_.put(place, *value++);
    });
    EXPECT_EQ(value, cells.end());
    stitched_ += sent.parts.empty() ? 0 : 1;
  }

  int pick(int below) { return std::uniform_int_distribution{0, below - 1}(random_); }

  std::mt19937_64 random_{GetParam()};
  MapQueue queue_{0};
  std::uint64_t number_ = 0;
  int stitched_ = 0;
  std::map<Place, std::uint8_t> newest_;
  std::map<Place, std::set<std::uint8_t>> posted_;
  Replay overwriting_{false}, overlaying_{true};
};

TEST_P(StitchLaws, ServerHasTheNewestValueOfEachPostedCell) {
  run();
  EXPECT_GT(stitched_, 5);
  for (const auto& [place, value] : overwriting_.cells) {
    EXPECT_TRUE(posted_.contains(place) || value == icd::kUnknownCell)
        << "the server has a cell that was not posted";
  }
  for (const auto& [place, value] : newest_) {
    EXPECT_EQ(overwriting_.cells.at(place), value) << "an overwriting server also has unknown cells";
  }
  for (const auto& [place, value] : newest_) {
    const auto has = overlaying_.cells.find(place);
    if (value != icd::kUnknownCell) {
      ASSERT_NE(has, overlaying_.cells.end());
      EXPECT_EQ(has->second, value);
    } else if (has != overlaying_.cells.end()) {
      EXPECT_TRUE(posted_.at(place).contains(has->second))
          << "a known cell stays known on an overlaying server";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Courses, StitchLaws, testing::Range(std::uint64_t{1}, std::uint64_t{16}));

}  // namespace
}  // namespace adit::queues
