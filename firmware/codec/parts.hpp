#pragma once

#include <optional>

#include "codec/cbor_writer.hpp"
#include "codec/field.hpp"
#include "icd/header.hpp"
#include "icd/markers_update.hpp"
#include "icd/robot_name.hpp"
#include "icd/rules.hpp"

/// The parts of messages that have rules of their own.
namespace adit::codec {

/// The optional "header" of a message (ICD 6.1, 6.2). A frame_id "" is ROS's word for none.
icd::Header read_header(const Field& message, const icd::Rules& rules);

/// With frame_id always: there are servers that refuse a message without a header.
void write_header(CborWriter& out, const icd::Header& header);

icd::MarkerAction read_action(const Field& field);

/// An alias gives the name it stands for. Refuses, and gives nothing, where the text is no robot's name
/// (ICD 2).
std::optional<icd::RobotName> read_robot_name(const Field& field, const icd::Rules& rules);

}  // namespace adit::codec
