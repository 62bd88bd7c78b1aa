#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>

#include "rehearsal/command_post/messages.hpp"

namespace adit::rehearsal {

/// By the machine's clock.
using Moment = std::chrono::sys_time<std::chrono::milliseconds>;

/// When a map's data was posted, as adit-robots writes it into its maps (README.md, 'How old').
struct Dates {
  Moment newest;
  // Of a cloud: how many different points were posted then. A cloud that was joined of several has some of
  // them twice.
  std::map<Moment, std::uint64_t> points;
};

/// Nothing of a map that tells no date. A date is read as the one nearest to `now`.
std::optional<Dates> dates_of(const MapMessage& map, Moment now);

}  // namespace adit::rehearsal
