#pragma once

#include <cstdint>

namespace adit::pace {

/// The bytes of TCP payload per second that maps may use on a link of `megabit` Mbit/s (> 0): 11.5 MB/s at
/// 100 Mbit/s. Full frames on that link carry 11.77 MB/s. The frames then stay within the link, and a report
/// does not queue behind a map.
std::uint64_t map_bytes_per_second(double megabit);

}  // namespace adit::pace
