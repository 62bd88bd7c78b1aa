#include "codec/read_parts.hpp"

namespace adit::codec {
namespace {

icd::Quaternion read_quaternion(const Field& field) {
  const icd::Quaternion read = {.x = field.member("x").number(),
                                .y = field.member("y").number(),
                                .z = field.member("z").number(),
                                .w = field.member("w").number()};
  constexpr icd::Quaternion kAllZero = {.x = 0, .y = 0, .z = 0, .w = 0};
  return read == kAllZero ? icd::Quaternion{} : read;
}

}  // namespace

icd::Header read_header(const Field& message, const icd::Rules& rules) {
  icd::Header read;
  const Field header = message.member("header");
  if (header.is_absent()) return read;
  if (const Field stamp = header.member("stamp"); !stamp.is_absent()) read.stamp = stamp.seconds();
  if (const Field frame_id = header.member("frame_id"); !frame_id.is_absent()) {
    const std::string_view text = frame_id.text();
    if (text != icd::kFrame && !text.empty())
      header.reading().keep(icd::check_frame_id(text, frame_id.path(), rules));
  }
  return read;
}

icd::Point read_point(const Field& field) {
  return {.x = field.member("x").number(), .y = field.member("y").number(), .z = field.member("z").number()};
}

icd::Pose read_pose(const Field& field) {
  return {.position = read_point(field.member("position")),
          .orientation = read_quaternion(field.member("orientation"))};
}

std::optional<icd::RobotName> read_robot_name(const Field& field, const icd::Rules& rules) {
  const std::string_view text = field.text();
  if (const auto alias = rules.aliases.find(text); alias != rules.aliases.end()) return alias->second;
  auto name = icd::RobotName::parse(text);
  if (!name) {
    field.refuse("expected 1 to ", icd::RobotName::kLongest, " letters, digits and underscores, got ",
                 icd::in_quotes(text),
                 text.empty() ? "" : " (the setting robots[].alias gives a name to whoever calls itself so)");
  }
  return name;
}

}  // namespace adit::codec
