#include "pack/pack.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "codec/gzip.hpp"
#include "pack/layouts.hpp"

namespace adit::pack {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(WithoutInvalidPoints, DropsWhatIsNotFiniteWhateverTheLayoutAndTheChunks) {
  std::mt19937_64 random{1};
  for (const Layout& layout : kLayouts) {
    const double largest = layout.datatype == icd::Datatype::Float32
                               ? static_cast<double>(std::numeric_limits<float>::max())
                               : std::numeric_limits<double>::max();
    const double values[] = {0, -0.0, 1.5, -1e-30, largest, -largest, kNan, kInfinity, -kInfinity, 65504};
    const auto any = [&] {
      // Mostly finite, so that points survive.
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
      const auto kept = without_invalid_points(cloud_of(layout), cut_up(all, random));
      ASSERT_EQ(kept.bytes.to_vector(), valid) << layout.what;
      EXPECT_EQ(kept.raw_size, valid.size()) << layout.what;
      EXPECT_EQ(kept.compression, icd::Compression::None);
    }
  }
}

TEST(WithoutInvalidPoints, CopiesNothingWhereAllPointsAreFinite) {
  const Layout& layout = kLayouts[0];
  std::mt19937_64 random{2};
  Bytes all;
  for (int i = 0; i < 1000; ++i) {
    const Bytes point = point_of(layout, i, 0, 0, 0);
    all.insert(all.end(), point.begin(), point.end());
  }
  const auto data = cut_up(all, random);
  const auto kept = without_invalid_points(cloud_of(layout), data);
  ASSERT_EQ(kept.bytes.chunks().size(), data.bytes.chunks().size());
  for (std::size_t i = 0; i < data.bytes.chunks().size(); ++i) {
    EXPECT_EQ(kept.bytes.chunks()[i]->data(), data.bytes.chunks()[i]->data()) << "shared";
  }
}

TEST(OnlyInvalidPoints, AreInACloudThatHasPointsAndNoneThatIsFinite) {
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

TEST(Pack, GzipsACloudsFinitePoints) {
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

TEST(Pack, LeavesACloudThatGzipDoesNotMakeSmaller) {
  const Layout& layout = kLayouts[0];
  const Bytes one = point_of(layout, 1, 2, 3, 4);
  for (const Bytes& bytes : {one, Bytes{}}) {
    const auto packed = pack(cloud_update(layout, bytes));
    EXPECT_EQ(packed.data.compression, icd::Compression::None);
    EXPECT_EQ(packed.data.bytes.to_vector(), bytes);
  }
}

TEST(Pack, MakesAnEmptyCloudOfOneWithoutAnyValidPoint) {
  const Layout& layout = kLayouts[0];
  const auto packed = pack(cloud_update(layout, point_of(layout, kNan, 0, 0, 0)));
  EXPECT_TRUE(packed.data.bytes.empty());
  EXPECT_EQ(packed.data.raw_size, 0);
  EXPECT_EQ(packed.data.compression, icd::Compression::None);
}

TEST(Pack, LeavesACloudThatIsCompressedAsItIs) {
  auto cloud = cloud_update(kLayouts[0], Bytes{1, 2, 3});
  cloud.data.compression = icd::Compression::Gzip;
  EXPECT_EQ(pack(cloud), cloud);
}

}  // namespace
}  // namespace adit::pack
