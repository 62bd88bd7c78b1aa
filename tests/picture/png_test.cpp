#include <gmock/gmock.h>
#include <zlib.h>

#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "picture/maps.hpp"
#include "picture/palette.hpp"

namespace adit::picture {
namespace {

/// A viewer's reading of an indexed PNG, written from ISO/IEC 15948 for the tests. Throws if the standard
/// is violated.
struct DecodedPng {
  std::uint32_t width = 0, height = 0;
  std::string palette, alpha;         // PLTE and tRNS
  std::vector<std::uint8_t> indices;  // row by row from the top
  std::vector<std::string> chunks;    // their names, in order
};

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<std::uint8_t>(bytes.at(at + i));
  return number;
}

std::uint32_t crc_of(const std::string& bytes) {  // Annex D, bit by bit
  std::uint32_t crc = 0xffffffff;
  for (const char byte : bytes) {
    crc ^= static_cast<std::uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? 0xedb88320 ^ crc >> 1 : crc >> 1;
  }
  return ~crc;
}

void require(bool kept, const char* what) {
  if (!kept) throw std::runtime_error(what);
}

DecodedPng decode_png(const std::string& png) {
  require(png.starts_with(std::string("\x89PNG\r\n\x1a\n", 8)), "signature");
  DecodedPng decoded;
  std::string deflated;
  for (std::size_t at = 8; at < png.size();) {
    const std::size_t size = number_at(png, at);
    const std::string name = png.substr(at + 4, 4), content = png.substr(at + 8, size);
    require(content.size() == size, "a chunk is cut short");
    require(number_at(png, at + 8 + size) == crc_of(name + content), "a chunk's checksum");
    decoded.chunks.push_back(name);
    if (name == "IHDR") {
      decoded.width = number_at(content, 0), decoded.height = number_at(content, 4);
      require(content.substr(8) == std::string("\x08\x03\x00\x00\x00", 5), "8 bits, indexed, not interlaced");
    } else if (name == "PLTE") {
      decoded.palette = content;
    } else if (name == "tRNS") {
      decoded.alpha = content;
    } else if (name == "IDAT") {
      deflated += content;
    }
    at += size + 12;
  }
  uLongf size = (decoded.width + 1) * decoded.height;
  std::vector<std::uint8_t> rows(size + 1);
  uLongf made = rows.size();
  require(uncompress(rows.data(), &made, reinterpret_cast<const Bytef*>(deflated.data()), deflated.size()) ==
              Z_OK,
          "the zlib stream");
  require(made == size, "as many bytes as pixels and filters");
  for (std::uint32_t row = 0; row < decoded.height; ++row) {
    const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(row) * (decoded.width + 1);
    require(*begin == 0, "no filter");
    decoded.indices.insert(decoded.indices.end(), begin + 1, begin + 1 + decoded.width);
  }
  return decoded;
}

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

TEST(Png, DecodesToTheSamePixelsAndColours) {
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

TEST(Png, OnlyUnknownPixelsAreTransparent) {
  Packer packer;
  EXPECT_EQ(decode_png(write_png(*packer.pack({}), grid_palette())).alpha, std::string(1, '\0'));
}

TEST(Png, OfAGridHasExactlyTheColoursOfItsIndices) {
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

TEST(Packer, DifferentTilesHaveDifferentChecksums) {
  Packer packer;
  Pixels one{}, other{};
  other[77] = 1;
  EXPECT_NE(packer.pack(one)->crc, packer.pack(other)->crc);
  EXPECT_EQ(packer.pack(one)->crc, packer.pack(one)->crc);
}

TEST(Palette, HigherIsLighter) {
  for (const auto& palette : {cloud_palette(), cloud_palette(-2, 5)}) {
    for (std::size_t i = 2; i < palette.size(); ++i) {
      EXPECT_GE(lightness(palette[i]) + 0.002, lightness(palette[i - 1])) << i;
    }
    EXPECT_GT(contrast(lightness(palette[255]), lightness(palette[1])), 5);
  }
}

TEST(Palette, FreeAndOccupiedContrastOnBothBackgrounds) {
  const double dark = lightness({0x0c, 0x0f, 0x11}), light = lightness({0xf3, 0xf1, 0xec});  // page.css
  const double free = lightness(grid_palette()[kFree]), occupied = lightness(grid_palette()[kOccupied]);
  EXPECT_GT(contrast(free, occupied), 3);
  EXPECT_GT(contrast(free, dark), 3);
  EXPECT_GT(contrast(occupied, light), 3);
  EXPECT_GT(contrast(occupied, dark), 2.5);
}

TEST(Palette, EachHeightHasOneIndex) {
  EXPECT_EQ(height_index(-1000), 1);
  EXPECT_EQ(height_index(kLowest), 1);
  EXPECT_EQ(height_index(kHighest), 255);
  EXPECT_EQ(height_index(1e300), 255);
  for (int index = 1; index <= 255; ++index) {
    EXPECT_EQ(height_index(height_of(static_cast<std::uint8_t>(index))), index);
  }
}

TEST(Palette, SpreadsTheColoursOverTheRequestedHeights) {
  const auto palette = cloud_palette(0, 4);
  EXPECT_EQ(palette[height_index(-3)], palette[height_index(-8)]);
  EXPECT_EQ(palette[height_index(4.5)], height_ramp().back());
  EXPECT_NE(palette[height_index(1)], palette[height_index(1.5)]);
  EXPECT_EQ(cloud_palette(7, 7)[255], height_ramp().back()) << "no height range counts as one step";
}

}  // namespace

}  // namespace adit::picture
