#pragma once

#include <cstdint>
#include <string_view>

namespace adit::queues {

/// How a robot's clouds relate to each other.
enum class Clouds : std::uint8_t {
  Auto,   // a newer cloud replaces an older one if it has all its points
  Whole,  // each cloud contains all earlier ones and replaces them
  Parts,  // each cloud must be delivered
};
inline constexpr std::string_view kCloudsWords[] = {"auto", "whole", "parts"};

}  // namespace adit::queues
