#pragma once

#include <optional>

namespace adit::icd {

/// Seconds, on the clock of whoever made the message; from 0 (ICD 6.2) to kLatestStamp.
using Stamp = double;
inline constexpr Stamp kLatestStamp = 0x1.fffffffffffffp31;  // ROS's time has its seconds in a uint32

/// The frame that every message is in (ICD 6.1). A message that exists has passed that check, so a Header
/// does not hold it.
inline constexpr const char* kFrame = "darpa";

struct Header {
  std::optional<Stamp> stamp;
  friend bool operator==(const Header&, const Header&) = default;
};

}  // namespace adit::icd
