// POST /state/update and POST /markers/update (ICD 6.5, 6.6).
#include <map>
#include <utility>
#include <vector>

#include "codec/members.hpp"
#include "codec/read.hpp"
#include "icd/require.hpp"

namespace adit::codec {
namespace {

icd::Marker read_marker(const Field& field, const icd::Rules& rules) {
  icd::Marker marker;
  read_members(field, marker, rules);
  if (marker.ns.empty() && marker.action != icd::MarkerAction::DeleteAll) marker.ns = icd::kUnnamedMarkers;
  return marker;
}

/// The newest pose of each robot in a state, and its place.
class PoseList {
 public:
  explicit PoseList(std::vector<icd::NamedPose>& poses) : poses_(poses) {}

  void add(const icd::NamedPose& named) {
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
  icd::Pose pose;
  read_members(field, pose, rules);
  if (!name) return std::unexpected(field.reading().outcome(0).error());
  return field.reading().outcome(icd::NamedPose{.name = *name, .pose = pose});
}

/// Reads each element of `list` separately: `keep` gets good ones, `refused` the others.
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
      refused.add(std::move(part.error()));
    }
  }
}

/// Refuses a message without good parts. Otherwise returns it with its refused parts.
template <class Message>
icd::Checked<CheckedParts<Message>> check_parts(Reading& reading, Message message, RefusedParts refused) {
  if (!reading.has_refusal() && refused.count > 0 && refused.others == 0) reading.refuse(refused.refusal());
  return reading.outcome(CheckedParts<Message>{std::move(message), std::move(refused)});
}

template <class Message>
icd::Checked<Message> require_all_parts(icd::Checked<CheckedParts<Message>> parts) {
  if (!parts) return std::unexpected(std::move(parts.error()));
  parts->refused.others = 0;  // no part is accepted
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
    sentence += icd::sentence(" (the other ", others, others == 1 ? " was accepted)" : " were accepted)");
  return {icd::Status::UnprocessableEntity, std::move(sentence), count, setting};
}

icd::Checked<CheckedParts<icd::StateUpdate>> read_state_parts(const Document& document,
                                                              const icd::Rules& rules) {
  Reading reading;
  icd::StateUpdate update;
  RefusedParts refused;
  const Field body(document.root, reading);
  update.header = read_header(body, rules);
  PoseList poses(update.poses);
  read_each(
      body.member("poses"), refused, [&](const Field& field) { return read_named_pose(field, rules); },
      [&](const icd::NamedPose& named) { poses.add(named); });
  return check_parts(reading, std::move(update), std::move(refused));
}

icd::Checked<CheckedParts<icd::MarkersUpdate>> read_markers_parts(const Document& document,
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
  update.markers.reserve(markers.size());
  read_each(
      markers, refused,
      [&](const Field& field) { return field.reading().outcome(read_marker(field, rules)); },
      [&](icd::Marker marker) { update.markers.push_back(std::move(marker)); });
  return check_parts(reading, std::move(update), std::move(refused));
}

icd::Checked<icd::StateUpdate> read_state_update(const Document& document, const icd::Rules& rules) {
  return require_all_parts(read_state_parts(document, rules));
}

icd::Checked<icd::MarkersUpdate> read_markers_update(const Document& document, const icd::Rules& rules) {
  return require_all_parts(read_markers_parts(document, rules));
}

}  // namespace adit::codec
