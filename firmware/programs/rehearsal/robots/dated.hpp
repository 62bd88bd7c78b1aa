#pragma once

#include <chrono>
#include <cstdint>

#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// Maps that tell when they were posted, by the machine's clock, so that a rehearsal Command Post can measure
/// how old they are when they arrive, whatever was merged or stitched on their way (rehearsal/README.md,
/// 'How old'). The two programs share no code: it reads the same by rules of its own.

using Moment = std::chrono::sys_time<std::chrono::milliseconds>;

/// Puts the moment into the first ten cells of the lowest row: five that say so, and five digits to the base
/// 101, the highest first, of the milliseconds since 1970 modulo 101^5 (121 days). A narrower grid stays.
void date(Grid& grid, Moment posted);

/// Adds to each point `posted_ms`, uint32: the milliseconds since 1970 modulo 2^32.
void date(Cloud& cloud, Moment posted);

}  // namespace adit::robots
