#pragma once

#include <string_view>

#include "codec/field.hpp"
#include "icd/geometry.hpp"
#include "icd/header.hpp"
#include "icd/robot_name.hpp"
#include "icd/rules.hpp"

namespace adit::codec {

/// The optional "header" of a message (ICD 6.1, 6.2). A frame_id "" is ROS's word for none.
icd::Header read_header(const Field& message, const icd::Rules& rules);

icd::Point read_point(const Field& field);

/// A pose's "position" and "orientation". An all-zero quaternion, as ROS leaves one that nobody set, becomes
/// the identity.
icd::Pose read_pose(const Field& field);

/// An alias gives the name it stands for. Refuses, and gives nothing, where the text is no robot's name
/// (ICD 2).
std::optional<icd::RobotName> read_robot_name(const Field& field, const icd::Rules& rules);

}  // namespace adit::codec
