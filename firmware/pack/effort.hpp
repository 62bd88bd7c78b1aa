#pragma once

#include <cstddef>
#include <cstdint>

#include "icd/map_update.hpp"

namespace adit::pack {

/// How much is done to make a cloud small.
enum class Effort : std::uint8_t {
  None,   // as it came, but for points that are not finite
  Quick,  // without padding, in the order in which it came, by the fastest level of gzip
  Full,   // all that CloudForm says
};

/// A cloud that might leave at once, and what that hangs on.
struct Hurry {
  double bytes_per_second = 1;  // that its link carries
  double slowness = 1;          // of this box: kSecondsPerByte times that
  double longest = 0;           // seconds that it may be under way
};

/// What an effort takes for a byte, and what Full makes of a byte that Quick makes: as measured
/// (tests/bench/README.md, of exact clouds).
inline constexpr double kSecondsPerByte[] = {0, 7e-9, 15e-9};
inline constexpr double kFullOfQuick = 0.85;

/// The effort with which the last byte of a cloud of `size` bytes is there first, if Quick makes `quick_to`
/// of a byte. Full, unless another one saves a tenth of the time, for what is larger is in the way of others;
/// none that takes longer than `longest` to leave, but Full.
Effort effort_for(std::size_t size, double quick_to, const Hurry& hurry);

/// The same, for an exact cloud that is not compressed: a part of it is tried, where that can matter.
Effort effort_for(const icd::MapData& points, const Hurry& hurry);

/// How slow this box is, where that effort took `seconds` for a cloud of `size` > 0 bytes; 1 for None.
double slowness(Effort effort, std::size_t size, double seconds);

}  // namespace adit::pack
