#include "rehearsal/robots/cave.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace adit::robots {
namespace {

constexpr std::uint64_t kSeeds[] = {1, 2, 3, 99, 20211001};

std::size_t open_cells(const Cave& cave) {
  std::size_t open = 0;
  for (std::size_t i = 0; i < cave.lattice().size(); ++i)
    open += cave.is_open(cave.lattice().cell_at(i)) ? 1 : 0;
  return open;
}

std::size_t cells_reached_from_the_entrance(const Cave& cave) {
  Raster<std::uint8_t> reached(cave.lattice(), 0);
  std::vector<Cell> edge = {cave.entrance()};
  std::size_t count = 0;
  while (!edge.empty()) {
    const Cell cell = edge.back();
    edge.pop_back();
    if (!cave.is_open(cell) || reached[cell] != 0) continue;
    reached[cell] = 1;
    ++count;
    for (const Cell next :
         {Cell{cell.x + 1, cell.y}, {cell.x - 1, cell.y}, {cell.x, cell.y + 1}, {cell.x, cell.y - 1}}) {
      edge.push_back(next);
    }
  }
  return count;
}

TEST(Cave, IsTheSameForTheSameSeed) {
  const Cave a = Cave::generate(7), b = Cave::generate(7);
  EXPECT_EQ(a.truth_csv(), b.truth_csv());
  for (std::size_t i = 0; i < a.lattice().size(); ++i) {
    const Cell cell = a.lattice().cell_at(i);
    ASSERT_EQ(a.is_open(cell), b.is_open(cell)) << i;
    ASSERT_EQ(a.floor_at(cell), b.floor_at(cell)) << i;
  }
}

TEST(Cave, DiffersForAnotherSeed) {
  EXPECT_NE(Cave::generate(1).truth_csv(), Cave::generate(2).truth_csv());
}

TEST(Cave, IsReachableFromTheEntrance) {
  for (const std::uint64_t seed : kSeeds) {
    const Cave cave = Cave::generate(seed);
    EXPECT_GT(open_cells(cave), 10'000u) << seed;
    EXPECT_EQ(cells_reached_from_the_entrance(cave), open_cells(cave)) << seed;
  }
}

TEST(Cave, HasItsEntranceAtTheOrigin) {
  const Cave cave = Cave::generate(3);
  EXPECT_TRUE(cave.is_open(cave.entrance()));
  EXPECT_EQ(cave.floor_at(cave.entrance()), 0);
}

TEST(Cave, HasRockAllRound) {
  const Cave cave = Cave::generate(3);
  const Lattice& lattice = cave.lattice();
  for (int x = 0; x < lattice.width; ++x) {
    EXPECT_FALSE(cave.is_open({x, 0}) || cave.is_open({x, lattice.height - 1}));
  }
  EXPECT_FALSE(cave.is_open({-1, 5}));
}

TEST(Cave, HasTwoDistantArtifactsOfEachType) {
  for (const std::uint64_t seed : kSeeds) {
    const Cave cave = Cave::generate(seed);
    std::map<std::string, int> types;
    for (const Artifact& artifact : cave.artifacts()) {
      ++types[artifact.type];
      const Cell cell = cave.lattice().cell_at(artifact.position.x, artifact.position.y);
      EXPECT_TRUE(cave.is_open(cell));
      EXPECT_GE(artifact.position.z, cave.floor_at(cell));
      for (const Artifact& other : cave.artifacts()) {
        if (&other == &artifact) continue;
        const double far =
            std::hypot(other.position.x - artifact.position.x, other.position.y - artifact.position.y);
        EXPECT_GE(far, Cave::kApart) << seed;
      }
    }
    EXPECT_EQ(types.size(), 10u) << seed;
    for (const auto& [type, count] : types) EXPECT_EQ(count, 2) << type;
  }
}

TEST(Cave, ShowsItsFirstArtifactFromTheEntrance) {
  for (const std::uint64_t seed : kSeeds) {
    const Cave cave = Cave::generate(seed);
    const Vector3& first = cave.artifacts().front().position;
    EXPECT_LT(std::hypot(first.x, first.y), 6) << seed;
    EXPECT_TRUE(cave.can_see({}, first)) << seed;
  }
}

TEST(Cave, WritesOneLineForEachArtifact) {
  const std::string csv = Cave::generate(5).truth_csv();
  EXPECT_TRUE(csv.starts_with("type,x,y,z\n"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 21);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), ','), 21 * 3);
}

}  // namespace
}  // namespace adit::robots
