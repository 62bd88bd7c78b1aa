#include "pack/pack.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "codec/gzip.hpp"
#include "icd/chunked_bytes.hpp"
#include "pack/grids.hpp"
#include "pack/layouts.hpp"

namespace adit::pack {
namespace {

/// The content of the gzip member `bytes`, inflated by zlib. Fails the test if `bytes` are not one member, or
/// if more bytes follow it. `most`: a limit above the expected size.
std::vector<std::uint8_t> only_member(const icd::ChunkedBytes& bytes, std::size_t most) {
  std::vector<std::uint8_t> member = bytes.to_vector(), out(most + 1);
  z_stream stream{};
  inflateInit2(&stream, MAX_WBITS + 16);
  stream.next_in = member.data();
  stream.avail_in = static_cast<uInt>(member.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END) << (stream.msg == nullptr ? "cut short" : stream.msg);
  EXPECT_EQ(stream.avail_in, 0U) << "bytes after the member";
  out.resize(stream.total_out);
  inflateEnd(&stream);
  return out;
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(WithoutInvalidPoints, DropsNonFinitePointsOfAnyLayout) {
  std::mt19937_64 random{1};
  for (const Layout& layout : kLayouts) {
    const double largest = layout.datatype == icd::Datatype::Float32
                               ? static_cast<double>(std::numeric_limits<float>::max())
                               : std::numeric_limits<double>::max();
    const double values[] = {0, -0.0, 1.5, -1e-30, largest, -largest, kNan, kInfinity, -kInfinity, 65504};
    const auto any = [&] {
      // Mostly finite values, so that points survive.
      return values[std::uniform_int_distribution{0, random() % 3 == 0 ? 9 : 5}(random)];
    };
    for (int round = 0; round < 20; ++round) {
      Bytes all, valid;
      const int count = std::uniform_int_distribution{0, layout.step > 1000 ? 4 : 300}(random);
      for (int i = 0; i < count; ++i) {
        const double x = any(), y = any(), z = any();
        const Bytes point = point_of(layout, x, y, z, static_cast<std::uint8_t>(i));
        all.insert(all.end(), point.begin(), point.end());
        if (std::isfinite(x) && std::isfinite(y) && std::isfinite(z)) {
          valid.insert(valid.end(), point.begin(), point.end());
        }
      }
      const auto kept = remove_invalid_points(cloud_of(layout), cut_up(all, random));
      ASSERT_EQ(kept.bytes.to_vector(), valid) << layout.what;
      EXPECT_EQ(kept.raw_size, valid.size()) << layout.what;
      EXPECT_EQ(kept.compression, icd::Compression::None);
    }
  }
}

TEST(WithoutInvalidPoints, CopiesNothingIfAllPointsAreFinite) {
  const Layout& layout = kLayouts[0];
  std::mt19937_64 random{2};
  Bytes all;
  for (int i = 0; i < 1000; ++i) {
    const Bytes point = point_of(layout, i, 0, 0, 0);
    all.insert(all.end(), point.begin(), point.end());
  }
  const auto data = cut_up(all, random);
  const auto kept = remove_invalid_points(cloud_of(layout), data);
  ASSERT_EQ(kept.bytes.chunks().size(), data.bytes.chunks().size());
  for (std::size_t i = 0; i < data.bytes.chunks().size(); ++i) {
    EXPECT_EQ(kept.bytes.chunks()[i]->data(), data.bytes.chunks()[i]->data()) << "shared";
  }
}

TEST(OnlyInvalidPoints, AreInACloudWithoutFinitePoints) {
  std::mt19937_64 random{3};
  for (const Layout& layout : kLayouts) {
    const auto has_only_invalid = [&](const std::vector<double>& xs) {
      Bytes all;
      for (const double x : xs) {
        const Bytes point = point_of(layout, 1, x, 2, 0);
        all.insert(all.end(), point.begin(), point.end());
      }
      return has_only_invalid_points({.name = {}, .msg = cloud_of(layout), .data = cut_up(all, random)});
    };
    EXPECT_TRUE(has_only_invalid({kNan})) << layout.what;
    EXPECT_TRUE(has_only_invalid({kInfinity, kNan, -kInfinity})) << layout.what;
    EXPECT_FALSE(has_only_invalid({kNan, kNan, 0})) << layout.what;
    EXPECT_FALSE(has_only_invalid({0, kNan})) << layout.what;
    EXPECT_FALSE(has_only_invalid({})) << layout.what;
  }
  EXPECT_FALSE(has_only_invalid_points({.name = {}, .msg = icd::OccupancyGrid{}, .data = {}}));
}

Bytes inflated(const icd::MapData& data) {
  Bytes out;
  const auto size = codec::gunzip(data.bytes, 1u << 30, "data", [&](std::span<const std::uint8_t> piece) {
    out.insert(out.end(), piece.begin(), piece.end());
    return icd::Checked<void>{};
  });
  EXPECT_TRUE(size);
  return out;
}

icd::MapUpdate cloud_update(const Layout& layout, const Bytes& bytes) {
  return {{}, cloud_of(layout), {icd::ChunkedBytes{bytes}, icd::Compression::None, bytes.size()}};
}

TEST(Pack, GzipsFinitePoints) {
  const Layout& layout = kLayouts[0];
  Bytes all, valid;
  for (int i = 0; i < 20'000; ++i) {
    const Bytes point = point_of(layout, i % 100, i % 7 == 0 ? kNan : 1, 2, 3);
    all.insert(all.end(), point.begin(), point.end());
    if (i % 7 != 0) valid.insert(valid.end(), point.begin(), point.end());
  }
  const auto packed = pack(cloud_update(layout, all), {.is_arranged = false});
  EXPECT_EQ(packed.data.compression, icd::Compression::Gzip);
  EXPECT_LT(packed.data.bytes.size(), valid.size() / 4);
  EXPECT_EQ(packed.data.raw_size, valid.size());
  EXPECT_EQ(inflated(packed.data), valid);
}

TEST(Pack, KeepsACloudThatGzipDoesNotMakeSmaller) {
  const Layout& layout = kLayouts[0];
  const Bytes one = point_of(layout, 1, 2, 3, 4);
  for (const Bytes& bytes : {one, Bytes{}}) {
    const auto packed = pack(cloud_update(layout, bytes));
    EXPECT_EQ(packed.data.compression, icd::Compression::None);
    EXPECT_EQ(packed.data.bytes.to_vector(), bytes);
  }
}

TEST(Pack, EmptiesACloudWithoutValidPoints) {
  const Layout& layout = kLayouts[0];
  const auto packed = pack(cloud_update(layout, point_of(layout, kNan, 0, 0, 0)));
  EXPECT_TRUE(packed.data.bytes.empty());
  EXPECT_EQ(packed.data.raw_size, 0);
  EXPECT_EQ(packed.data.compression, icd::Compression::None);
}

TEST(Pack, KeepsACompressedCloud) {
  auto cloud = cloud_update(kLayouts[0], Bytes{1, 2, 3});
  cloud.data.compression = icd::Compression::Gzip;
  EXPECT_EQ(pack(cloud), cloud);
}

/// The grid as it is stored.
icd::MapData kept(const Grid& grid) {
  return {codec::gzip(icd::ChunkedBytes(grid.cells), codec::GzipStrategy::Runs), icd::Compression::Gzip,
          grid.cells.size()};
}

icd::MapData kept_by(int level, const Grid& grid) {
  return {*codec::gzip(grid.cells, level, 2 * grid.cells.size() + 100), icd::Compression::Gzip,
          grid.cells.size()};
}

std::vector<Grid> grids() {
  return {cave(400, 300, 1),           graded(cave(400, 300, 2)),
          speckled(cave(400, 300, 3)), measured(cave(400, 300, 4)),
          noise(300, 300, 101),        noise(300, 300, 2),
          noise(300, 300, 256),        Grid("all unknown", 2000, 1000),
          Grid("one row", 90'000, 1),  Grid("few cells", 20, 20)};
}

TEST(PackCells, KeepsEachCellAndNeverGrows) {
  for (const Grid& grid : grids()) {
    for (const icd::MapData& data : {kept(grid), kept_by(1, grid), kept_by(12, grid)}) {
      for (const Effort effort : {Effort::Quick, Effort::Full}) {
        SCOPED_TRACE(grid.what);
        const icd::MapData packed = *pack_cells(data, effort);
        EXPECT_EQ(packed.raw_size, grid.cells.size());
        EXPECT_LE(packed.bytes.size(), std::min(data.bytes.size(), grid.cells.size()));
        if (packed.compression == icd::Compression::None) {
          EXPECT_EQ(packed.bytes.to_vector(), grid.cells);
        } else {
          EXPECT_EQ(only_member(packed.bytes, grid.cells.size()), grid.cells);
        }
      }
    }
  }
}

TEST(PackCells, UsesTheSmallestResultForItsEffort) {
  const Grid grid = graded(cave(400, 300, 8));
  EXPECT_EQ(pack_cells(kept(grid), Effort::Full), kept_by(kCellsLevel, grid));
  EXPECT_EQ(pack_cells(kept(grid), Effort::Quick), kept_by(kQuickCellsLevel, grid));
  EXPECT_EQ(pack_cells(kept(grid), Effort::None), kept(grid));
  EXPECT_EQ(pack_cells(kept_by(12, grid), Effort::Full), kept_by(12, grid));
}

TEST(PackCells, KeepsASingleCell) {
  const Grid grid("one cell", 1, 1);
  const icd::MapData cell{icd::ChunkedBytes(grid.cells), icd::Compression::None, 1};
  EXPECT_EQ(pack_cells(kept(grid), Effort::Full), cell);
  EXPECT_EQ(pack_cells(cell, Effort::Full), cell);
}

TEST(PackCells, ReportsDamagedData) {
  icd::MapData damaged = kept(cave(300, 300, 3));
  std::vector<std::uint8_t> member = damaged.bytes.to_vector();
  member[member.size() / 2] ^= 0x10;
  damaged.bytes = icd::ChunkedBytes(member);
  EXPECT_EQ(pack_cells(damaged, Effort::Full), std::nullopt);
}

}  // namespace

}  // namespace adit::pack
