#pragma once

#include <array>
#include <cstddef>
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

/// How far the coordinates of a robot's clouds may be rounded, so that a message holds more of them.
enum class Precision : std::uint8_t {
  Exact,
  Millimetre,        // within 1.3 mm
  EightMillimetres,  // within 11 mm
  Auto,              // the finest at which all queued clouds fit into one message
};
inline constexpr std::string_view kPrecisionWords[] = {"exact", "1mm", "8mm", "auto"};

/// For each precision except Auto: how many bytes of points, as posted, fit into one message.
using PointsAt = std::array<std::size_t, 3>;
inline constexpr PointsAt kAnyPoints{SIZE_MAX, SIZE_MAX, SIZE_MAX};

/// The finest precision at which `waiting` bytes of points fit into one message, or else the coarsest.
constexpr Precision precision_for(std::size_t waiting, const PointsAt& holds) {
  if (waiting <= holds[0]) return Precision::Exact;
  return waiting <= holds[1] ? Precision::Millimetre : Precision::EightMillimetres;
}

}  // namespace adit::queues
