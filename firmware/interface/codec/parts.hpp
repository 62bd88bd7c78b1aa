#pragma once

#include <optional>

#include "codec/cbor_writer.hpp"
#include "codec/field.hpp"
#include "icd/header.hpp"
#include "icd/markers_update.hpp"
#include "icd/robot_name.hpp"
#include "icd/rules.hpp"

/// Parts of messages with rules of their own.
namespace adit::codec {

/// The optional "header" of a message (ICD 6.1, 6.2). In ROS a frame_id "" means absent.
icd::Header read_header(const Field& message, const icd::Rules& rules);

/// Always writes frame_id, because some servers reject a message without a header.
void write_header(CborWriter& out, const icd::Header& header);

icd::MarkerAction read_action(const Field& field);

/// Replaces an alias by its name. Refuses and returns std::nullopt if the text is not a robot's name (ICD 2).
std::optional<icd::RobotName> read_robot_name(const Field& field, const icd::Rules& rules);

}  // namespace adit::codec
