#include "picture/palette.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace adit::picture {
namespace {

constexpr Colour kFree{0xc8, 0xd2, 0xda}, kOccupied{0xa8, 0x32, 0x1e};

/// Viridis in steps of an eighth of its length, without the first.
constexpr Colour kRamp[] = {{71, 44, 122},  {59, 81, 139}, {44, 113, 142}, {33, 144, 141},
                            {39, 173, 129}, {92, 200, 99}, {170, 220, 50}, {253, 231, 37}};

std::uint8_t blend(std::uint8_t a, std::uint8_t b, double part) {
  return static_cast<std::uint8_t>(std::lround(a + (b - a) * part));
}

Colour blend(const Colour& a, const Colour& b, double part) {
  return {blend(a.red, b.red, part), blend(a.green, b.green, part), blend(a.blue, b.blue, part)};
}

/// The colour at `part` of the ramp, 0 to 1.
Colour ramp_at(double part) {
  const double at = part * (std::size(kRamp) - 1);
  const auto before = std::min(static_cast<std::size_t>(at), std::size(kRamp) - 2);
  return blend(kRamp[before], kRamp[before + 1], at - static_cast<double>(before));
}

/// `ramp(part)`: the colour of a height at this part of the way from `low` to `high`, 0 to 1.
template <class Ramp>
std::array<Colour, 256> palette_of(double low, double high, Ramp ramp) {
  std::array<Colour, 256> colours;
  const double span = std::max(high - low, kHeightStep);
  for (std::size_t index = 1; index < colours.size(); ++index) {
    const double part = (height_of(static_cast<std::uint8_t>(index)) - low) / span;
    colours[index] = ramp(std::clamp(part, 0.0, 1.0));
  }
  return colours;
}

}  // namespace

std::array<Colour, kMostOccupiedIndex + 1> grid_palette(const Colour& free, const Colour& occupied) {
  std::array<Colour, kMostOccupiedIndex + 1> colours;
  for (std::size_t value = 0; value < kMostOccupiedIndex; ++value) {
    colours[value + 1] = blend(free, occupied, static_cast<double>(value) / (kMostOccupiedIndex - 1));
  }
  return colours;
}

std::span<const Colour> grid_palette() {
  static const auto palette = grid_palette(kFree, kOccupied);
  return palette;
}

std::span<const Colour> height_ramp() {
  return kRamp;
}

std::uint8_t height_index(double z) {
  constexpr double kMost = 254;
  return static_cast<std::uint8_t>(1 + std::clamp((z - kLowest) * (1 / kHeightStep), 0.0, kMost));
}

double height_of(std::uint8_t index) {
  return kLowest + (index - 0.5) * kHeightStep;
}

std::array<Colour, 256> cloud_palette(double low, double high) {
  return palette_of(low, high, ramp_at);
}

std::array<Colour, 256> cloud_palette(double low, double high, const Colour& lowest, const Colour& highest) {
  return palette_of(low, high, [&](double part) { return blend(lowest, highest, part); });
}

namespace {

constexpr std::string_view kSignature{"\x89PNG\r\n\x1a\n", 8};
constexpr char kBitDepth = 8, kIndexed = 3;

void append_number(std::string& png, std::uint32_t number) {  // PNG 7.1: most significant byte first
  for (const int shift : {24, 16, 8, 0}) png.push_back(static_cast<char>(number >> shift & 0xff));
}

void append_chunk(std::string& png, std::string_view type, std::string_view content) {
  append_number(png, static_cast<std::uint32_t>(content.size()));
  const std::size_t begin = png.size();
  png.append(type).append(content);
  const auto* summed = reinterpret_cast<const Bytef*>(png.data() + begin);
  append_number(png, static_cast<std::uint32_t>(crc32(0, summed, static_cast<uInt>(png.size() - begin))));
}

std::string head() {
  std::string content;
  append_number(content, kSide);
  append_number(content, kSide);
  return content + kBitDepth + kIndexed + std::string(3, '\0');  // deflate, usual filters, no interlace
}

std::string bytes_of(std::span<const Colour> palette) {
  std::string bytes;
  for (const Colour& colour : palette) {
    for (const std::uint8_t part : {colour.red, colour.green, colour.blue}) {
      bytes.push_back(static_cast<char>(part));
    }
  }
  return bytes;
}

}  // namespace

std::string write_png(const PackedTile& tile, std::span<const Colour> palette) {
  constexpr std::size_t kFraming = 128;
  std::string png;
  png.reserve(tile.deflated.size() + palette.size() * 3 + kFraming);
  png += kSignature;
  append_chunk(png, "IHDR", head());
  append_chunk(png, "PLTE", bytes_of(palette));
  append_chunk(png, "tRNS", std::string_view("\0", 1));  // of index 0; the others are opaque
  append_number(png, static_cast<std::uint32_t>(tile.deflated.size()));
  png.append("IDAT").append(reinterpret_cast<const char*>(tile.deflated.data()), tile.deflated.size());
  append_number(png, tile.crc);
  append_chunk(png, "IEND", {});
  return png;
}

}  // namespace adit::picture
