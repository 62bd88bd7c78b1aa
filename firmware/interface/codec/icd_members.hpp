#pragma once

#include <tuple>

#include "codec/members.hpp"
#include "codec/parts.hpp"
#include "icd/map_update.hpp"
#include "icd/markers_update.hpp"

/// The ICD's messages (6), each member in the order of its listings, and ROS's further members.
namespace adit::codec {

/// "header": {"stamp", "frame_id"}.
struct HeaderMember {
  void read(const Field& parent, auto& into, const icd::Rules& rules) const {
    into.header = read_header(parent, rules);
  }
  static std::size_t written(const auto& /*from*/) { return 1; }
  void write(CborWriter& out, const auto& from) const { write_header(out, from.header); }
};

/// "type" and "action". The action is read first, because it decides which members a marker needs.
struct TypeAndAction {
  void read(const Field& parent, icd::Marker& into, const icd::Rules& rules) const {
    into.action = read_action(parent.member("action"));
    kType.read(parent, into, rules);
  }
  static std::size_t written(const icd::Marker& /*from*/) { return 2; }
  void write(CborWriter& out, const icd::Marker& from) const {
    kType.write(out, from);
    out.text("action");
    out.whole(static_cast<std::int64_t>(from.action));
  }

 private:
  static constexpr auto kType =
      named("type", &icd::Marker::type).from(0).to(icd::kLastMarkerType).needed(Need::ToAdd);
};

template <>
inline constexpr auto members_of<icd::Point> =
    std::tuple(named("x", &icd::Point::x), named("y", &icd::Point::y), named("z", &icd::Point::z));

template <>
inline constexpr auto members_of<icd::Quaternion> =
    std::tuple(named("x", &icd::Quaternion::x), named("y", &icd::Quaternion::y),
               named("z", &icd::Quaternion::z), named("w", &icd::Quaternion::w));

template <>
inline constexpr auto members_of<icd::Pose> =
    std::tuple(named("position", &icd::Pose::position), named("orientation", &icd::Pose::orientation));

template <>
inline constexpr auto members_of<icd::Color> =
    std::tuple(named("r", &icd::Color::r).from(0).to(1), named("g", &icd::Color::g).from(0).to(1),
               named("b", &icd::Color::b).from(0).to(1), named("a", &icd::Color::a).from(0).to(1));

template <>
inline constexpr auto members_of<icd::OccupancyGrid> =  // 6.3.1
    std::tuple(HeaderMember{},
               group("info", named("resolution", &icd::OccupancyGrid::resolution),
                     named("width", &icd::OccupancyGrid::width).from(1).to(icd::kMostCellsASide),
                     named("height", &icd::OccupancyGrid::height).from(1).to(icd::kMostCellsASide),
                     named("origin", &icd::OccupancyGrid::origin)));

template <>
inline constexpr auto members_of<icd::FieldSchema> =
    std::tuple(named("name", &icd::FieldSchema::name), named("offset", &icd::FieldSchema::offset),
               named("datatype", &icd::FieldSchema::datatype).from(1).to(8),
               named("count", &icd::FieldSchema::count).from(1));

template <>
inline constexpr auto members_of<icd::PointCloud2> =  // 6.3.2
    std::tuple(HeaderMember{}, named("origin", &icd::PointCloud2::origin).needed(Need::MayLack),
               named("fields", &icd::PointCloud2::fields).to(icd::kMostFields, " fields"),
               named("is_bigendian", &icd::PointCloud2::is_bigendian).needed(Need::MayLack),
               named("point_step", &icd::PointCloud2::point_step).from(1).to(icd::kLargestPoint));

template <>
inline constexpr auto members_of<icd::Marker> = std::tuple(  // 6.6
    HeaderMember{}, named("ns", &icd::Marker::ns).needed(Need::MayLack),
    named("id", &icd::Marker::id).needed(Need::MayLack), TypeAndAction{},
    named("pose", &icd::Marker::pose).needed(Need::ToAdd),
    named("scale", &icd::Marker::scale).needed(Need::ToAdd),
    named("color", &icd::Marker::color).needed(Need::ToAdd),
    named("lifetime", &icd::Marker::lifetime).time_to(icd::kLongestLifetime).needed(Need::MayLack),
    named("text", &icd::Marker::text).needed(Need::MayLack),
    // ROS's further members of a Marker. The number of colors may differ from the number of points; viewers
    // then ignore the colors.
    named("frame_locked", &icd::Marker::frame_locked).needed(Need::IfSaid),
    named("points", &icd::Marker::points).to(icd::kMostMarkerPoints).needed(Need::IfSaid),
    named("colors", &icd::Marker::colors).to(icd::kMostMarkerPoints).needed(Need::IfSaid),
    named("mesh_resource", &icd::Marker::mesh_resource)
        .to(icd::kLongestMeshResource, " bytes")
        .needed(Need::IfSaid),
    named("mesh_use_embedded_materials", &icd::Marker::mesh_use_embedded_materials).needed(Need::IfSaid));

}  // namespace adit::codec
