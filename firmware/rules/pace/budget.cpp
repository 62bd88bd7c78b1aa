#include "pace/budget.hpp"

#include <algorithm>

namespace adit::pace {

std::uint64_t map_bytes_per_second(double megabit) {
  constexpr double kWireBytes = 1e6 / 8;        // a second, for each Mbit/s
  constexpr double kPayload = 1448.0 / 1538.0;  // of a full TCP frame with time stamps, preamble and gap
  constexpr double kForMaps = 0.98;             // the rest is for reports, states, markers and ACKs
  constexpr double kMostMegabit = 1e6;
  const double bytes = std::min(megabit, kMostMegabit) * kWireBytes * kPayload * kForMaps;
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(bytes));
}

}  // namespace adit::pace
