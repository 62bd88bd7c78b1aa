#pragma once

#include <optional>

namespace adit::icd {

/// Seconds on the sender's clock, from 0 (ICD 6.2) to kLatestStamp.
using Stamp = double;
inline constexpr Stamp kLatestStamp = 0x1.fffffffffffffp31;  // ROS has its seconds in a uint32

/// The frame of every message (ICD 6.1). It was checked when the message was parsed, so a Header does not
/// contain it.
inline constexpr const char* kFrame = "darpa";

struct Header {
  std::optional<Stamp> stamp;
  friend bool operator==(const Header&, const Header&) = default;
};

}  // namespace adit::icd
