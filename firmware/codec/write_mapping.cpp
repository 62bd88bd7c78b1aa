// The mapping endpoint's messages (ICD 6), members in the order of the ICD's listings.
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

void write_point(CborWriter& out, std::string_view name, const icd::Point& point) {
  out.text(name);
  out.map(3);
  write_real(out, "x", point.x);
  write_real(out, "y", point.y);
  write_real(out, "z", point.z);
}

/// The two members of a pose.
void write_pose_members(CborWriter& out, const icd::Pose& pose) {
  write_point(out, "position", pose.position);
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

void write_data(CborWriter& out, const icd::MapData& data) {
  out.text("data");
  out.byte_string(data.bytes);
  write_text(out, "compression", data.compression == icd::Compression::Gzip ? "gzip" : "none");
}

void write_msg(CborWriter& out, const icd::OccupancyGrid& grid, const icd::MapData& data) {
  out.map(4);
  write_header(out, grid.header);
  out.text("info");
  out.map(4);
  write_real(out, "resolution", grid.resolution);
  write_whole(out, "width", grid.width);
  write_whole(out, "height", grid.height);
  write_pose(out, "origin", grid.origin);
  write_data(out, data);
}

void write_msg(CborWriter& out, const icd::PointCloud2& cloud, const icd::MapData& data) {
  out.map(7);
  write_header(out, cloud.header);
  write_pose(out, "origin", cloud.origin.value_or(icd::Pose{}));
  out.text("fields");
  out.array(cloud.fields.size());
  for (const icd::FieldSchema& field : cloud.fields) {
    out.map(4);
    write_text(out, "name", field.name);
    write_whole(out, "offset", field.offset);
    write_whole(out, "datatype", static_cast<std::int64_t>(field.datatype));
    write_whole(out, "count", field.count);
  }
  out.text("is_bigendian");
  out.truth(cloud.is_bigendian);
  write_whole(out, "point_step", cloud.point_step);
  write_data(out, data);
}

void write_marker(CborWriter& out, const icd::Marker& marker) {
  out.map(10);
  write_header(out, marker.header);
  write_text(out, "ns", marker.ns);
  write_whole(out, "id", marker.id);
  write_whole(out, "type", marker.type);
  write_whole(out, "action", static_cast<std::int64_t>(marker.action));
  write_pose(out, "pose", marker.pose);
  write_point(out, "scale", marker.scale);
  out.text("color");
  out.map(4);
  write_real(out, "r", marker.color.r);
  write_real(out, "g", marker.color.g);
  write_real(out, "b", marker.color.b);
  write_real(out, "a", marker.color.a);
  write_real(out, "lifetime", marker.lifetime);
  write_text(out, "text", marker.text);
}

}  // namespace

icd::ChunkedBytes write_map_update(const icd::MapUpdate& update) {
  CborWriter out;
  out.map(3);
  write_text(out, "type", update.is_grid() ? "OccupancyGrid" : "PointCloud2");
  write_text(out, "name", update.name ? update.name->text() : std::string_view());
  out.text("msg");
  std::visit([&](const auto& msg) { write_msg(out, msg, update.data); }, update.msg);
  return out.finish();
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
