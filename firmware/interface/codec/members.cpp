#include "codec/members.hpp"

namespace adit::codec {
icd::Header read_header(const Field& message, const icd::Rules& rules) {
  icd::Header read;
  const Field header = message.member("header");
  if (header.is_absent()) return read;
  if (const Field stamp = header.member("stamp"); !stamp.is_absent())
    read.stamp = stamp.seconds(icd::kLatestStamp);
  if (const Field frame_id = header.member("frame_id"); !frame_id.is_absent()) {
    const std::string_view text = frame_id.text();
    if (text != icd::kFrame && !text.empty())
      header.reading().keep(icd::check_frame_id(text, frame_id.path(), rules));
  }
  return read;
}

void write_header(CborWriter& out, const icd::Header& header) {
  out.text("header");
  out.map(header.stamp ? 2 : 1);
  if (header.stamp) {
    out.text("stamp");
    out.floating(*header.stamp);
  }
  out.text("frame_id");
  out.text(icd::kFrame);
}

icd::MarkerAction read_action(const Field& field) {
  if (field.is_absent()) {
    field.refuse_kind("a whole number");
    return icd::MarkerAction::Delete;  // needs no more members, so that only the action is named
  }
  const auto action = field.integer<std::int64_t>();
  for (const auto known : {icd::MarkerAction::Add, icd::MarkerAction::Delete, icd::MarkerAction::DeleteAll}) {
    if (action == static_cast<std::int64_t>(known)) return known;
  }
  field.refuse("expected 0 (add), 2 (delete) or 3 (delete all), got ", action);
  return icd::MarkerAction::Add;
}

std::optional<icd::RobotName> read_robot_name(const Field& field, const icd::Rules& rules) {
  const std::string_view text = field.text();
  if (const auto alias = rules.aliases.find(text); alias != rules.aliases.end()) return alias->second;
  auto name = icd::RobotName::parse(text);
  if (!name) {
    field.refuse_by_setting(
        text.empty() ? "" : "robots[].alias", "expected 1 to ", icd::RobotName::kLongest,
        " letters, digits and underscores, got ", icd::quote_text(text),
        text.empty() ? "" : " (the setting robots[].alias can map this name to a valid one)");
  }
  return name;
}

}  // namespace adit::codec
