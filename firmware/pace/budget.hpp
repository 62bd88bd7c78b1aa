#pragma once

#include <cstdint>

namespace adit::pace {

/// The most that maps may use of a link of `megabit` Mbit/s, in bytes per second of TCP payload, so that the
/// frames on the wire stay within the link and a report never waits behind a map: 11.5 MB/s of 100 Mbit/s,
/// where full frames carry 11.77 MB/s of payload. megabit > 0.
std::uint64_t map_bytes_per_second(double megabit);

}  // namespace adit::pace
