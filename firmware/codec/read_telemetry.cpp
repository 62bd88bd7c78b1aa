// POST /state/update and POST /markers/update (ICD 6.5, 6.6).
#include <map>

#include "codec/read.hpp"
#include "codec/read_parts.hpp"

namespace adit::codec {
namespace {

icd::MarkerAction read_action(const Field& field) {
  const auto action = field.whole<std::int64_t>();
  for (const auto known : {icd::MarkerAction::Add, icd::MarkerAction::Delete, icd::MarkerAction::DeleteAll}) {
    if (action == static_cast<std::int64_t>(known)) return known;
  }
  field.refuse("expected 0 (add), 2 (delete) or 3 (delete all), got ", action);
  return icd::MarkerAction::Add;
}

icd::Color read_color(const Field& field) {
  return {.r = field.member("r").number(0, 1),
          .g = field.member("g").number(0, 1),
          .b = field.member("b").number(0, 1),
          .a = field.member("a").number(0, 1)};
}

icd::Marker read_marker(const Field& field, const icd::Rules& rules) {
  icd::Marker marker;
  marker.header = read_header(field, rules);
  if (const Field ns = field.member("ns"); !ns.is_absent()) marker.ns = ns.text();
  if (const Field id = field.member("id"); !id.is_absent()) marker.id = id.whole<std::int32_t>();
  marker.action = read_action(field.member("action"));

  const bool adds = marker.action == icd::MarkerAction::Add;
  const auto asked = [adds](const Field& member) { return adds || !member.is_absent(); };
  if (const Field type = field.member("type"); asked(type)) {
    marker.type = type.whole<std::int32_t>(0, icd::kLastMarkerType);
  }
  if (const Field pose = field.member("pose"); asked(pose)) marker.pose = read_pose(pose);
  if (const Field scale = field.member("scale"); asked(scale)) marker.scale = read_point(scale);
  if (const Field color = field.member("color"); asked(color)) marker.color = read_color(color);
  if (const Field lifetime = field.member("lifetime"); !lifetime.is_absent()) {
    marker.lifetime = lifetime.seconds();
  }
  if (const Field text = field.member("text"); !text.is_absent()) marker.text = text.text();
  return marker;
}

}  // namespace

icd::Checked<icd::StateUpdate> read_state_update(const Document& document, const icd::Rules& rules) {
  Reading reading;
  icd::StateUpdate update;
  const Field body(document.root, reading);
  update.header = read_header(body, rules);
  const Field poses = body.member("poses");
  std::map<icd::RobotName, std::size_t> places;
  const std::size_t count = poses.size();
  for (std::size_t i = 0; i < count && !reading.refused(); ++i) {
    const Field named = poses.element(i);
    const auto name = read_robot_name(named.member("name"), rules);
    const icd::Pose pose = read_pose(named);
    if (!name) break;
    const auto [place, is_new] = places.try_emplace(*name, update.poses.size());
    if (is_new) update.poses.push_back({.name = *name, .pose = pose});
    update.poses[place->second].pose = pose;
  }
  return reading.outcome(std::move(update));
}

icd::Checked<icd::MarkersUpdate> read_markers_update(const Document& document, const icd::Rules& rules) {
  Reading reading;
  icd::MarkersUpdate update;
  const Field body(document.root, reading);
  const Field markers = body.member("markers");
  const std::size_t count = markers.size();
  for (std::size_t i = 0; i < count && !reading.refused(); ++i) {
    update.markers.push_back(read_marker(markers.element(i), rules));
  }
  return reading.outcome(std::move(update));
}

}  // namespace adit::codec
