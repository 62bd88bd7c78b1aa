// The effort to pack a map, by the rate of its link and the speed of the box.
#include <gtest/gtest.h>

#include "icd/xyz.hpp"
#include "pack/generated.hpp"
#include "pack/pack.hpp"

namespace adit::pack {
namespace {

constexpr double kMegabyte = 1e6, kSlot = 1;
/// Compressed bytes per byte with Quick, as measured.
constexpr double kNoise = 0.92, kScan = 0.7, kSurvey = 0.48, kPadded = 0.39;

struct Row {
  const char* what;
  double megabytes_a_second, megabytes, quick_to, slowness;
  Effort expected;
};

void PrintTo(const Row& row, std::ostream* out) {
  *out << row.what << ", " << row.megabytes << " MB at " << row.megabytes_a_second << " MB/s";
}

class EffortFor : public testing::TestWithParam<Row> {};

TEST_P(EffortFor, ACloudDelaysOthersLeastAndArrivesFirst) {
  const Row& row = GetParam();
  const EffortInput hurry{row.megabytes_a_second * kMegabyte, row.slowness, kSlot};
  EXPECT_EQ(effort_for(static_cast<std::size_t>(row.megabytes * kMegabyte), row.quick_to, hurry),
            row.expected);
}

// 1 Gbit/s are 115 MB/s, 100 are 11.5, 10 are 1.15 (pace::map_bytes_per_second).
INSTANTIATE_TEST_SUITE_P(
    Rates, EffortFor,
    testing::Values(Row{"loopback", 5000, 10, kScan, 1, Effort::None},
                    Row{"loopback, all alike", 5000, 10, 0.01, 1, Effort::None},
                    Row{"1 Gbit/s, noise", 115, 10, kNoise, 1, Effort::None},
                    Row{"1 Gbit/s, a scan", 115, 10, kScan, 1, Effort::None},
                    Row{"1 Gbit/s, a survey", 115, 10, kSurvey, 1, Effort::None},
                    Row{"1 Gbit/s, padded", 115, 10, 0.1, 1, Effort::Quick},
                    Row{"1 Gbit/s, more than a slot", 115, 140, kNoise, 0.4, Effort::Full},
                    Row{"1 Gbit/s, packed too slowly", 115, 140, kNoise, 1, Effort::Quick},
                    Row{"100 Mbit/s, noise", 11.5, 10, kNoise, 1, Effort::Full},
                    Row{"100 Mbit/s, a scan", 11.5, 10, kScan, 1, Effort::Full},
                    Row{"100 Mbit/s, a survey", 11.5, 10, kSurvey, 1, Effort::Full},
                    Row{"100 Mbit/s, padded", 11.5, 10, kPadded, 1, Effort::Full},
                    Row{"10 Mbit/s, noise", 1.15, 10, kNoise, 1, Effort::Full},
                    Row{"10 Mbit/s, small noise", 1.15, 0.5, kNoise, 1, Effort::Full},
                    Row{"10 Mbit/s, a small survey", 1.15, 0.5, kSurvey, 1, Effort::Full},
                    Row{"1 Mbit/s, small noise", 0.115, 0.3, kNoise, 1, Effort::Full}));

INSTANTIATE_TEST_SUITE_P(
    SlowBoxes, EffortFor,
    testing::Values(Row{"1 Gbit/s, padded", 115, 10, 0.1, 4, Effort::None},
                    Row{"100 Mbit/s, noise", 11.5, 10, kNoise, 4, Effort::None},
                    Row{"100 Mbit/s, a survey", 11.5, 10, kSurvey, 4, Effort::Quick},
                    Row{"100 Mbit/s, more than a slot", 11.5, 15, kNoise, 4, Effort::Full},
                    Row{"100 Mbit/s, packed too slowly", 11.5, 13, kNoise, 8, Effort::Quick},
                    Row{"100 Mbit/s, packed far too slowly", 11.5, 13, kNoise, 20, Effort::None},
                    Row{"10 Mbit/s, noise", 1.15, 10, kNoise, 4, Effort::Full},
                    Row{"10 Mbit/s, a small survey", 1.15, 0.5, kSurvey, 4, Effort::Full},
                    Row{"1 Mbit/s, small noise", 0.115, 0.3, kNoise, 10, Effort::Full}));

/// From slow to fast.
std::vector<double> rates() {
  std::vector<double> all;
  for (int tenths = 40; tenths <= 100; ++tenths) all.push_back(std::pow(10, tenths / 10.0));
  return all;
}

/// Worker and link together: the slower one delays other maps if it takes longer than a slot.
TEST(Effort, IsNeverWorseThanFull) {
  for (const double slowness : {0.2, 1.0, 5.0, 20.0}) {
    for (const double rate : rates()) {
      for (const double quick_to : {0.01, 0.3, 0.6, 0.9, 1.0}) {
        const EffortInput hurry{rate, slowness, kSlot};
        const double bytes = 3e6;
        const auto packs = [&](Effort effort) {
          return slowness * kSecondsPerByte[static_cast<std::size_t>(effort)] * bytes;
        };
        const auto takes = [&](Effort effort, double to) { return packs(effort) + bytes * to / rate; };
        const auto delays = [&](Effort effort, double to) {
          return std::max({packs(effort), bytes * to / rate, kSlot});
        };
        const Effort chosen = effort_for(3'000'000, quick_to, hurry);
        const double to = chosen == Effort::None ? 1 : quick_to;
        if (chosen == Effort::Full) continue;
        const double full_to = quick_to * kFullOfQuick, full_delays = delays(Effort::Full, full_to);
        EXPECT_LE(delays(chosen, to), full_delays);
        if (delays(chosen, to) == full_delays) EXPECT_LE(takes(chosen, to), takes(Effort::Full, full_to));
      }
    }
  }
}

/// If a link gets Full, an even slower one does.
TEST(Effort, IsFullOnEverySlowLink) {
  for (const double quick_to : {0.05, 0.5, 0.95}) {
    bool was_full = true;
    for (const double rate : rates()) {
      const bool is_full = effort_for(1'000'000, quick_to, {rate, 1, kSlot}) == Effort::Full;
      EXPECT_TRUE(was_full || !is_full) << rate;
      was_full = is_full;
    }
    EXPECT_FALSE(was_full);
  }
}

TEST(Effort, IsMeasuredOnTheCloud) {
  Generator make{3};
  icd::PointCloud2 padded = icd::xyz();
  padded.point_step = 64;
  const auto noise = [&](std::size_t) {
    return std::array{make.real(0, 1), make.real(0, 1), make.real(0, 1)};
  };
  icd::MapUpdate alike = update_of(padded, Bytes(64 * 50'000)), plain = make.cloud(icd::xyz(), 50'000, noise);
  const EffortInput hurry{60 * kMegabyte, 1, kSlot};
  EXPECT_EQ(effort_for(alike, hurry).effort, Effort::Quick);
  EXPECT_EQ(effort_for(plain, hurry).effort, Effort::None);
  EXPECT_EQ(effort_for(alike, {}).effort, Effort::Full) << "the link is slow";
  EXPECT_LT(effort_for(alike, hurry).full_to, 0.1);
  EXPECT_NEAR(effort_for(plain, hurry).full_to, kNoise * kFullOfQuick, 0.1);
}

TEST(Effort, IsNoneForNoPoints) {
  EXPECT_NO_FATAL_FAILURE((void)effort_for(update_of(icd::xyz(), {}), {1, 1, 1}));
  EXPECT_NO_FATAL_FAILURE((void)effort_for(update_of(icd::xyz(), Bytes(12)), {1, 1, 100}));
}

TEST(Effort, IsNoneBeyondTheLimit) {
  icd::MapUpdate cloud = update_of(icd::xyz(), Bytes(12000));
  const auto effort = [&](std::size_t size) {
    cloud.data.raw_size = size;
    return effort_for(cloud, {}).effort;
  };
  EXPECT_EQ(effort(kMostPacked), Effort::Full);
  EXPECT_EQ(effort(kMostPacked + 1), Effort::None);
}

struct GridRow {
  const char* what;
  double megacells, kept_megabytes;
  EffortInput hurry;
  Effort expected;
};

void PrintTo(const GridRow& row, std::ostream* out) {
  *out << row.what;
}

class EffortForAGrid : public testing::TestWithParam<GridRow> {};

TEST_P(EffortForAGrid, IsTheGreatestThatFitsItsSlot) {
  const auto size = [](double megabytes) { return static_cast<std::size_t>(megabytes * kMegabyte); };
  const GridRow& row = GetParam();
  icd::MapUpdate grid;
  grid.msg = icd::OccupancyGrid{};
  grid.data = {icd::ChunkedBytes(Bytes(size(row.kept_megabytes))), icd::Compression::Gzip,
               size(row.megacells)};
  EXPECT_EQ(effort_for(grid, row.hurry).effort, row.expected);
  const double takes = row.hurry.slowness * seconds_for(row.expected, grid);
  EXPECT_LE(takes, std::min(0.5, row.hurry.longest / 2));
}

INSTANTIATE_TEST_SUITE_P(
    Grids, EffortForAGrid,
    testing::Values(GridRow{"slow link", 3, 0.03, {1, 1, kSlot}, Effort::Full},
                    GridRow{"slow link, noise", 6, 1.1, {1, 1, kSlot}, Effort::Quick},
                    GridRow{"slow link, noise, slow slots", 6, 1.1, {1, 1, 60}, Effort::Quick},
                    GridRow{"slow link, fast slots", 2.9, 0.03, {1, 1, 0.1}, Effort::Quick},
                    GridRow{"slow link, slow box", 3, 0.03, {1, 4, kSlot}, Effort::Full},
                    GridRow{"slow link, slow box, large", 5, 0.06, {1, 4, kSlot}, Effort::Quick},
                    GridRow{"slow link, large", 16.7, 0.1, {1, 1, kSlot}, Effort::Full},
                    GridRow{"slow link, very large", 16.8, 0.1, {1, 1, kSlot}, Effort::None},
                    GridRow{"slow link, very large, noise", 29, 24, {1, 1, kSlot}, Effort::Quick},
                    GridRow{"slow link, more noise than half a slot", 30, 25, {1, 1, kSlot}, Effort::None},
                    GridRow{"slow link, too large", 42, 4, {1, 0.5, kSlot}, Effort::None},
                    GridRow{"slow link, slow box, noise", 20, 4, {1, 4, kSlot}, Effort::None},
                    GridRow{"100 Mbit/s", 3, 0.03, {11.5 * kMegabyte, 1, kSlot}, Effort::None},
                    GridRow{"100 Mbit/s, noise", 6, 5.2, {11.5 * kMegabyte, 1, kSlot}, Effort::Quick},
                    GridRow{"1 Mbit/s", 3, 0.03, {0.115 * kMegabyte, 1, kSlot}, Effort::Full}));

}  // namespace
}  // namespace adit::pack
