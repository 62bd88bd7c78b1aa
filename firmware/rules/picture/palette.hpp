#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "picture/tile.hpp"

namespace adit::picture {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend bool operator==(const Colour&, const Colour&) = default;
};

/// A tile's pixels are indices of colours. 0 is transparent and means unknown. A grid's cell of `value` per
/// cent has index value + 1. Free (0) is #c8d2da, occupied (100) is #a8321e, and values between are shades
/// between. Free ways are light and walls dark red, so lightness alone tells them apart, and both stand out
/// from a dark and a light background.
inline constexpr std::uint8_t kMostOccupiedIndex = 101;
std::span<const Colour> grid_palette();
/// The same with other colours, because a page has its own in each theme.
std::array<Colour, kMostOccupiedIndex + 1> grid_palette(const Colour& free, const Colour& occupied);

/// A cloud's height above z = 0 of "darpa". Index 1 is kLowest, and each further index is kHeightStep higher.
/// Heights beyond the ends have the first or the last index (255).
inline constexpr double kLowest = -20, kHeightStep = 0.2, kHighest = 31;
std::uint8_t height_index(double z);
/// The middle of the heights with this index.
double height_of(std::uint8_t index);

/// Colours for heights from `low` to `high`; heights beyond have the colours of the ends. Dark violet over
/// green to yellow, after "viridis" (Smith and van der Walt, CC0): its lightness grows steadily, for the
/// colour-blind and in grey. Its darkest shades, which would be lost on a dark page, are left out.
std::span<const Colour> height_ramp();  // evenly spaced, lowest first; colours between are mixed
std::array<Colour, 256> cloud_palette(double low = kLowest, double high = kHighest);
/// The same from one colour to another, for example of a robot or a theme.
std::array<Colour, 256> cloud_palette(double low, double high, const Colour& lowest, const Colour& highest);

/// A tile as an indexed PNG (ISO/IEC 15948) in which index 0 is transparent. The tile is deflated already, so
/// this takes some microseconds. `palette`: at least as many colours as the tile has indices, at most 256.
std::string write_png(const PackedTile& tile, std::span<const Colour> palette);

}  // namespace adit::picture
