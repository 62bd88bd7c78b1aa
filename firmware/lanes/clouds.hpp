#pragma once

#include <cstdint>
#include <string_view>

namespace adit::lanes {

/// What a robot's clouds are to each other.
enum class Clouds : std::uint8_t {
  Auto,   // a newer one replaces an older one where it has each of its points
  Whole,  // each says all that those before it said: it replaces them
  Parts,  // each is to arrive
};
inline constexpr std::string_view kCloudsWords[] = {"auto", "whole", "parts"};

}  // namespace adit::lanes
