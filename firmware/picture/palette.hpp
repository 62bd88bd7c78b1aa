#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace adit::picture {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend bool operator==(const Colour&, const Colour&) = default;
};

/// A tile's pixels are indices of colours; 0 is transparent: nothing is known there.
///
/// A grid's cell of `value` per cent is index value + 1. Free (0) is #c8d2da and occupied (100) #a8321e, with
/// the shades between for what is neither: a light way between dark red walls, told apart by their lightness
/// too, that stand out from a dark ground and from a light one.
inline constexpr std::uint8_t kMostOccupiedIndex = 101;
std::span<const Colour> grid_palette();
/// The same in other colours: a page has its own in each theme.
std::array<Colour, kMostOccupiedIndex + 1> grid_palette(const Colour& free, const Colour& occupied);

/// A cloud's height above z = 0 of the frame "darpa": index 1 is kLowest, each further one kHeightStep more;
/// what lies beyond has the first or the last index (255).
inline constexpr double kLowest = -20, kHeightStep = 0.2, kHighest = 31;
std::uint8_t height_index(double z);
/// The middle of the heights that have this index.
double height_of(std::uint8_t index);

/// Colours for heights from `low` to `high` (what lies beyond has the colours of the ends): from dark violet
/// over green to yellow, after "viridis" (Smith and van der Walt, CC0), which grows in lightness all the way
/// and so is told by the colour-blind and in grey. Its darkest shades, which would be lost on a dark page,
/// are left out.
std::span<const Colour> height_ramp();  // evenly spaced, the lowest first; those between are mixed
std::array<Colour, 256> cloud_palette(double low = kLowest, double high = kHighest);
/// The same from one colour to another: a robot's own, or those of a theme.
std::array<Colour, 256> cloud_palette(double low, double high, const Colour& lowest, const Colour& highest);

}  // namespace adit::picture
