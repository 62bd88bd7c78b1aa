// The mapping endpoint's messages (ICD 6), members in the order of the ICD's listings.
#include <cassert>

#include "codec/cbor_writer.hpp"
#include "codec/write.hpp"

namespace adit::codec {
namespace {

/// With frame_id always: there are servers that refuse a message without a header.
void write_header(CborWriter& out, const icd::Header& header) {
  out.text("header");
  out.map(header.stamp ? 2 : 1);
  if (header.stamp) {
    out.text("stamp");
    out.real(*header.stamp);
  }
  out.text("frame_id");
  out.text(icd::kFrame);
}

void write_real(CborWriter& out, std::string_view name, double number) {
  out.text(name);
  out.real(number);
}

void write_whole(CborWriter& out, std::string_view name, std::int64_t number) {
  out.text(name);
  out.whole(number);
}

void write_text(CborWriter& out, std::string_view name, std::string_view text) {
  out.text(name);
  out.text(text);
}

void write_truth(CborWriter& out, std::string_view name, bool yes) {
  out.text(name);
  out.truth(yes);
}

void write_item(CborWriter& out, const icd::Point& point) {
  out.map(3);
  write_real(out, "x", point.x);
  write_real(out, "y", point.y);
  write_real(out, "z", point.z);
}

void write_item(CborWriter& out, const icd::Color& color) {
  out.map(4);
  write_real(out, "r", color.r);
  write_real(out, "g", color.g);
  write_real(out, "b", color.b);
  write_real(out, "a", color.a);
}

template <class Item>
void write_named(CborWriter& out, std::string_view name, const Item& item) {
  out.text(name);
  write_item(out, item);
}

template <class Item>
void write_list(CborWriter& out, std::string_view name, const std::vector<Item>& items) {
  out.text(name);
  out.array(items.size());
  for (const Item& item : items) write_item(out, item);
}

/// The two members of a pose.
void write_pose_members(CborWriter& out, const icd::Pose& pose) {
  write_named(out, "position", pose.position);
  out.text("orientation");
  out.map(4);
  write_real(out, "x", pose.orientation.x);
  write_real(out, "y", pose.orientation.y);
  write_real(out, "z", pose.orientation.z);
  write_real(out, "w", pose.orientation.w);
}

void write_pose(CborWriter& out, std::string_view name, const icd::Pose& pose) {
  out.text(name);
  out.map(2);
  write_pose_members(out, pose);
}

void write_compression(CborWriter& out, const icd::MapData& data) {
  write_text(out, "compression", data.compression == icd::Compression::Gzip ? "gzip" : "none");
}

std::size_t members_of(const icd::OccupancyGrid&) {
  return 4;
}
std::size_t members_of(const icd::PointCloud2& cloud) {
  return cloud.origin ? 7 : 6;
}

/// All members but data and its compression.
void write_members(CborWriter& out, const icd::OccupancyGrid& grid) {
  write_header(out, grid.header);
  out.text("info");
  out.map(4);
  write_real(out, "resolution", grid.resolution);
  write_whole(out, "width", grid.width);
  write_whole(out, "height", grid.height);
  write_pose(out, "origin", grid.origin);
}

void write_members(CborWriter& out, const icd::PointCloud2& cloud) {
  write_header(out, cloud.header);
  if (cloud.origin) write_pose(out, "origin", *cloud.origin);
  out.text("fields");
  out.array(cloud.fields.size());
  for (const icd::FieldSchema& field : cloud.fields) {
    out.map(4);
    write_text(out, "name", field.name);
    write_whole(out, "offset", field.offset);
    write_whole(out, "datatype", static_cast<std::int64_t>(field.datatype));
    write_whole(out, "count", field.count);
  }
  write_truth(out, "is_bigendian", cloud.is_bigendian);
  write_whole(out, "point_step", cloud.point_step);
}

void write_type_and_name(CborWriter& out, const icd::MapUpdate& update) {
  write_text(out, "type", update.is_grid() ? "OccupancyGrid" : "PointCloud2");
  write_text(out, "name", update.name ? update.name->text() : std::string_view());
}

/// Up to the data: all that has to be known before it is how much it is, and how many members msg has.
std::string write_up_to_data(std::size_t members, std::uint64_t size) {
  CborWriter out;
  out.map(3);
  out.text("msg");
  out.map(members);
  out.text("data");
  std::string before = out.finish().to_string();
  before += '\x5B';  // a byte string whose length stands in 8 bytes (RFC 8949 3)
  for (int shift = 56; shift >= 0; shift -= 8) before += static_cast<char>(size >> shift & 0xFF);
  return before;
}

/// How many of the members that ROS has and the ICD does not list say something in this marker. The others
/// are left out: a reader takes them as ROS's defaults.
std::size_t unlisted_members(const icd::Marker& marker) {
  return std::size_t{marker.frame_locked} + !marker.points.empty() + !marker.colors.empty() +
         !marker.mesh_resource.empty() + marker.mesh_use_embedded_materials;
}

void write_marker(CborWriter& out, const icd::Marker& marker) {
  out.map(10 + unlisted_members(marker));
  write_header(out, marker.header);
  write_text(out, "ns", marker.ns);
  write_whole(out, "id", marker.id);
  write_whole(out, "type", marker.type);
  write_whole(out, "action", static_cast<std::int64_t>(marker.action));
  write_pose(out, "pose", marker.pose);
  write_named(out, "scale", marker.scale);
  write_named(out, "color", marker.color);
  write_real(out, "lifetime", marker.lifetime);
  write_text(out, "text", marker.text);
  if (marker.frame_locked) write_truth(out, "frame_locked", true);
  if (!marker.points.empty()) write_list(out, "points", marker.points);
  if (!marker.colors.empty()) write_list(out, "colors", marker.colors);
  if (!marker.mesh_resource.empty()) write_text(out, "mesh_resource", marker.mesh_resource);
  if (marker.mesh_use_embedded_materials) write_truth(out, "mesh_use_embedded_materials", true);
}

}  // namespace

icd::ChunkedBytes write_map_update(const icd::MapUpdate& update) {
  CborWriter out;
  out.map(3);
  write_type_and_name(out, update);
  out.text("msg");
  std::visit(
      [&](const auto& msg) {
        out.map(members_of(msg));
        write_members(out, msg);
      },
      update.msg);
  out.text("data");
  out.byte_string(update.data.bytes);
  write_compression(out, update.data);
  return out.finish();
}

DataFirst write_data_first(const icd::MapUpdate& update) {
  const std::size_t members = std::visit([](const auto& msg) { return members_of(msg); }, update.msg);
  CborWriter out;
  write_compression(out, update.data);
  std::visit([&](const auto& msg) { write_members(out, msg); }, update.msg);
  write_type_and_name(out, update);
  DataFirst written{.before = write_up_to_data(members, update.data.bytes.size()),
                    .after = out.finish().to_string()};
  assert(written.before.size() == DataFirst::kBefore);
  return written;
}

icd::ChunkedBytes write_state_update(const icd::StateUpdate& update) {
  CborWriter out;
  out.map(2);
  write_header(out, update.header);
  out.text("poses");
  out.array(update.poses.size());
  for (const icd::NamedPose& named : update.poses) {
    out.map(3);
    write_text(out, "name", named.name.text());
    write_pose_members(out, named.pose);
  }
  return out.finish();
}

icd::ChunkedBytes write_markers_update(const icd::MarkersUpdate& update) {
  CborWriter out;
  out.map(1);
  out.text("markers");
  out.array(update.markers.size());
  for (const icd::Marker& marker : update.markers) write_marker(out, marker);
  return out.finish();
}

}  // namespace adit::codec
