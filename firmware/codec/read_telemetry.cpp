// POST /state/update and POST /markers/update (ICD 6.5, 6.6).
#include <map>
#include <type_traits>
#include <utility>
#include <vector>

#include "codec/read.hpp"
#include "codec/read_parts.hpp"
#include "icd/require.hpp"

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

/// An array of at most kMostMarkerPoints, each read by `read`; absent: none.
template <class Read>
auto read_list(const Field& field, Read read) {
  std::vector<std::invoke_result_t<Read, const Field&>> list;
  if (field.is_absent()) return list;
  const std::size_t count = field.size();
  if (count > icd::kMostMarkerPoints) {
    field.refuse("expected at most ", icd::kMostMarkerPoints, ", got ", count);
    return list;
  }
  list.reserve(count);
  for (std::size_t i = 0; i < count && !field.reading().refused(); ++i) {
    list.push_back(read(field.element(i)));
  }
  return list;
}

std::string_view read_mesh_resource(const Field& field) {
  const std::string_view url = field.text();
  if (url.size() > icd::kLongestMeshResource) {
    field.refuse("expected at most ", icd::kLongestMeshResource, " bytes, got ", url.size());
  }
  return url;
}

/// What ROS's Marker has and the ICD does not list. How many colors there are is the sender's business:
/// whoever draws the marker ignores those that fit no points.
void read_geometry(const Field& field, icd::Marker& marker) {
  if (const Field frame_locked = field.member("frame_locked"); !frame_locked.is_absent()) {
    marker.frame_locked = frame_locked.truth();
  }
  marker.points = read_list(field.member("points"), read_point);
  marker.colors = read_list(field.member("colors"), read_color);
  if (const Field mesh = field.member("mesh_resource"); !mesh.is_absent()) {
    marker.mesh_resource = read_mesh_resource(mesh);
  }
  if (const Field materials = field.member("mesh_use_embedded_materials"); !materials.is_absent()) {
    marker.mesh_use_embedded_materials = materials.truth();
  }
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
  read_geometry(field, marker);
  return marker;
}

/// A state's newest pose of each robot, and where it stands.
class PoseList {
 public:
  explicit PoseList(std::vector<icd::NamedPose>& poses) : poses_(poses) {}

  void add(icd::NamedPose named) {
    const auto [place, is_new] = places_.try_emplace(named.name, poses_.size());
    if (is_new) poses_.push_back(named);
    poses_[place->second].pose = named.pose;
  }

 private:
  std::vector<icd::NamedPose>& poses_;
  std::map<icd::RobotName, std::size_t> places_;
};

icd::Checked<icd::NamedPose> read_named_pose(const Field& field, const icd::Rules& rules) {
  const auto name = read_robot_name(field.member("name"), rules);
  const icd::Pose pose = read_pose(field);
  if (!name) return std::unexpected(field.reading().outcome(0).error());
  return field.reading().outcome(icd::NamedPose{.name = *name, .pose = pose});
}

/// Reads each element of `list` by itself: `keep` gets the good ones, `refused` is told of the others.
template <class Read, class Keep>
void read_each(const Field& list, RefusedParts& refused, Read read, Keep keep) {
  const std::size_t count = list.size();
  for (std::size_t i = 0; i < count; ++i) {
    Reading reading;
    auto part = read(list.element(i, reading));
    if (part) {
      keep(*std::move(part));
      ++refused.others;
    } else {
      refused.add(std::move(part.error().sentence));
    }
  }
}

/// Nothing good in it: refused as a whole. Else the message, and what is not in it.
template <class Message>
icd::Checked<InParts<Message>> sorted(Reading& reading, Message message, RefusedParts refused) {
  if (!reading.refused() && refused.count > 0 && refused.others == 0) reading.refuse(refused.refusal());
  return reading.outcome(InParts<Message>{std::move(message), std::move(refused)});
}

template <class Message>
icd::Checked<Message> whole(icd::Checked<InParts<Message>> parts) {
  if (!parts) return std::unexpected(std::move(parts.error()));
  parts->refused.others = 0;  // for nothing of it is taken
  if (parts->refused.count > 0) return std::unexpected(parts->refused.refusal());
  return std::move(parts->message);
}

}  // namespace

icd::Refusal RefusedParts::refusal() const {
  icd::require(count > 0);
  std::string sentence;
  for (const char* between = ""; const std::string& one : sentences) {
    sentence += std::exchange(between, "; ");
    sentence += one;
  }
  if (count > sentences.size())
    sentence += icd::sentence("; and ", count - sentences.size(), " more like these");
  if (others > 0)
    sentence += icd::sentence(" (the other ", others, others == 1 ? " was taken)" : " were taken)");
  return {icd::Status::UnprocessableEntity, std::move(sentence), count};
}

icd::Checked<InParts<icd::StateUpdate>> read_state_parts(const Document& document, const icd::Rules& rules) {
  Reading reading;
  icd::StateUpdate update;
  RefusedParts refused;
  const Field body(document.root, reading);
  update.header = read_header(body, rules);
  PoseList poses(update.poses);
  read_each(
      body.member("poses"), refused, [&](const Field& field) { return read_named_pose(field, rules); },
      [&](icd::NamedPose named) { poses.add(std::move(named)); });
  return sorted(reading, std::move(update), std::move(refused));
}

icd::Checked<InParts<icd::MarkersUpdate>> read_markers_parts(const Document& document,
                                                             const icd::Rules& rules) {
  Reading reading;
  icd::MarkersUpdate update;
  RefusedParts refused;
  const Field body(document.root, reading);
  const Field markers = body.member("markers");
  if (const std::size_t count = markers.size(); count > icd::kMostMarkers) {
    return icd::unprocessable("markers: expected at most ", icd::kMostMarkers, " in one message, got ",
                              count);
  }
  read_each(
      markers, refused,
      [&](const Field& field) { return field.reading().outcome(read_marker(field, rules)); },
      [&](icd::Marker marker) { update.markers.push_back(std::move(marker)); });
  return sorted(reading, std::move(update), std::move(refused));
}

icd::Checked<icd::StateUpdate> read_state_update(const Document& document, const icd::Rules& rules) {
  return whole(read_state_parts(document, rules));
}

icd::Checked<icd::MarkersUpdate> read_markers_update(const Document& document, const icd::Rules& rules) {
  return whole(read_markers_parts(document, rules));
}

}  // namespace adit::codec
