#include "picture/png.hpp"

#include <gmock/gmock.h>

#include <random>

#include "picture/maps.hpp"
#include "picture/png_reader.hpp"

namespace adit::picture {
namespace {

Pixels noise(unsigned seed, int most) {
  std::mt19937 random{seed};
  Pixels pixels;
  for (auto& pixel : pixels) pixel = static_cast<std::uint8_t>(random() % static_cast<unsigned>(most + 1));
  return pixels;
}

/// How light a colour looks: relative luminance (WCAG 2).
double lightness(const Colour& colour) {
  const auto linear = [](std::uint8_t part) { return std::pow(part / 255.0, 2.2); };
  return 0.2126 * linear(colour.red) + 0.7152 * linear(colour.green) + 0.0722 * linear(colour.blue);
}

double contrast(double a, double b) {
  return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05);
}

TEST(Png, IsDecodedToTheSamePixelsAndColours) {
  Packer packer;
  for (const Pixels& pixels : {Pixels{}, noise(1, 255), noise(2, 1), noise(3, 101)}) {
    const auto palette = cloud_palette();
    const auto png = decode_png(write_png(*packer.pack(pixels), palette));
    EXPECT_EQ(png.width, 256U);
    EXPECT_EQ(png.height, 256U);
    EXPECT_TRUE(std::ranges::equal(png.indices, pixels));
    EXPECT_THAT(png.chunks, testing::ElementsAre("IHDR", "PLTE", "tRNS", "IDAT", "IEND"));
    ASSERT_EQ(png.palette.size(), 768U);
    for (std::size_t i = 0; i < palette.size(); ++i) {
      EXPECT_EQ(static_cast<std::uint8_t>(png.palette[3 * i]), palette[i].red);
      EXPECT_EQ(static_cast<std::uint8_t>(png.palette[3 * i + 1]), palette[i].green);
      EXPECT_EQ(static_cast<std::uint8_t>(png.palette[3 * i + 2]), palette[i].blue);
    }
  }
}

TEST(Png, OnlyWhatIsNotKnownIsTransparent) {
  Packer packer;
  EXPECT_EQ(decode_png(write_png(*packer.pack({}), grid_palette())).alpha, std::string(1, '\0'));
}

TEST(Png, OfAGridHasAColourForEachOfItsIndicesAndNoMore) {
  EXPECT_EQ(grid_palette().size(), 102U);
}

TEST(Packer, PacksTileAfterTileAndUnpacksThem) {
  Packer packer;
  std::vector<std::pair<Pixels, Tile>> all;
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Pixels pixels = noise(seed, seed % 2 == 0 ? 255 : 2);
    all.emplace_back(pixels, packer.pack(pixels));
  }
  for (const auto& [pixels, tile] : all) {
    Pixels back{};
    packer.unpack(*tile, back);
    EXPECT_EQ(back, pixels);
  }
}

TEST(Packer, TilesThatDifferHaveOtherChecksums) {
  Packer packer;
  Pixels one{}, other{};
  other[77] = 1;
  EXPECT_NE(packer.pack(one)->crc, packer.pack(other)->crc);
  EXPECT_EQ(packer.pack(one)->crc, packer.pack(one)->crc);
}

TEST(Palette, HeightsGrowLighterAllTheWay) {
  for (const auto& palette : {cloud_palette(), cloud_palette(-2, 5)}) {
    for (std::size_t i = 2; i < palette.size(); ++i) {
      EXPECT_GE(lightness(palette[i]) + 0.002, lightness(palette[i - 1])) << i;
    }
    EXPECT_GT(contrast(lightness(palette[255]), lightness(palette[1])), 5);
  }
}

TEST(Palette, FreeAndOccupiedStandOutFromEachOtherAndFromBothGrounds) {
  const double dark = lightness({0x0c, 0x0f, 0x11}), light = lightness({0xf3, 0xf1, 0xec});  // page.css
  const double free = lightness(grid_palette()[kFree]), occupied = lightness(grid_palette()[kOccupied]);
  EXPECT_GT(contrast(free, occupied), 3);
  EXPECT_GT(contrast(free, dark), 3);
  EXPECT_GT(contrast(occupied, light), 3);
  EXPECT_GT(contrast(occupied, dark), 2.5);
}

TEST(Palette, AHeightHasOneIndexWhateverElseIsDrawn) {
  EXPECT_EQ(height_index(-1000), 1);
  EXPECT_EQ(height_index(kLowest), 1);
  EXPECT_EQ(height_index(kHighest), 255);
  EXPECT_EQ(height_index(1e300), 255);
  for (int index = 1; index <= 255; ++index) {
    EXPECT_EQ(height_index(height_of(static_cast<std::uint8_t>(index))), index);
  }
}

TEST(Palette, SpreadsTheColoursOverTheHeightsAskedFor) {
  const auto palette = cloud_palette(0, 4);
  EXPECT_EQ(palette[height_index(-3)], palette[height_index(-8)]);
  EXPECT_EQ(palette[height_index(4.5)], height_ramp().back());
  EXPECT_NE(palette[height_index(1)], palette[height_index(1.5)]);
  EXPECT_EQ(cloud_palette(7, 7)[255], height_ramp().back()) << "no heights at all are taken for one step";
}

}  // namespace
}  // namespace adit::picture
