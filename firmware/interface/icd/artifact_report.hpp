#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "icd/geometry.hpp"
#include "icd/robot_name.hpp"

namespace adit::icd {

/// The artifact types of the final event (ICD 5.2). Letter case does not matter.
inline constexpr auto kArtifactTypes = std::to_array<std::string_view>({
#include "icd/artifact_types.inc"
});

/// The ICD's spelling of a type, or "" if it is unknown.
std::string_view artifact_type(std::string_view text);

/// The body of POST /api/artifact_reports (ICD 5.2). `type` is as the sender wrote it.
struct ArtifactReport {
  std::string type;
  Point position;
  std::optional<RobotName> robot = {};  // "name": in the ICD's example, not in its list of members
  friend bool operator==(const ArtifactReport&, const ArtifactReport&) = default;
};

}  // namespace adit::icd
