#pragma once

#include <vector>

#include "icd/geometry.hpp"
#include "icd/header.hpp"
#include "icd/robot_name.hpp"

namespace adit::icd {

struct NamedPose {
  RobotName name;
  Pose pose;
  friend bool operator==(const NamedPose&, const NamedPose&) = default;
};

/// The body of POST /state/update (ICD 6.5). Each name is in `poses` at most once.
struct StateUpdate {
  Header header;
  std::vector<NamedPose> poses;
  friend bool operator==(const StateUpdate&, const StateUpdate&) = default;
};

}  // namespace adit::icd
