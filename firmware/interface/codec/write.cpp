// The scoring endpoint's messages (ICD 5), and JSON strings for error replies (ICD 4).
// The mapping endpoint's messages (ICD 6), with members in the ICD's order.
#include "codec/write.hpp"

#include <zlib.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "codec/cbor.hpp"
#include "codec/members.hpp"
#include "codec/utf8.hpp"
#include "icd/members.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::codec {
namespace {

void append_escaped(std::string& out, char control) {
  switch (control) {
    case '\n':
      out += "\\n";
      return;
    case '\r':
      out += "\\r";
      return;
    case '\t':
      out += "\\t";
      return;
    default:
      out += "\\u00" + icd::hex(static_cast<std::uint8_t>(control));
  }
}

bool needs_no_escape(char letter) {
  return letter >= ' ' && letter <= '~' && letter != '"' && letter != '\\';
}

}  // namespace

std::string write_artifact_report(const icd::ArtifactReport& report) {
  static_assert(icd::count_of_members<icd::ArtifactReport>() == 3, "write each member");
  return icd::sentence(
      "{\"x\": ", json_number(report.position.x), ", \"y\": ", json_number(report.position.y),
      ", \"z\": ", json_number(report.position.z), ", \"type\": ", json_string(report.type),
      report.robot ? icd::sentence(", \"name\": ", json_string(report.robot->text())) : "", "}");
}

std::string json_number(double number) {
  return std::isfinite(number) ? icd::real_text(number) : "null";
}

std::string json_string(std::string_view text) {
  std::string out = "\"";
  while (!text.empty()) {
    const auto plain =
        static_cast<std::size_t>(std::ranges::find_if_not(text, needs_no_escape) - text.begin());
    out += text.substr(0, plain);
    text.remove_prefix(plain);
    if (text.empty()) break;
    const std::size_t size = character_size(text);
    if (size == 0) {
      out += "\xef\xbf\xbd";  // U+FFFD
    } else if (static_cast<std::uint8_t>(text[0]) < 0x20 || text[0] == 0x7f) {
      append_escaped(out, text[0]);
    } else {
      if (text[0] == '"' || text[0] == '\\') out += '\\';
      out += text.substr(0, size);
    }
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  out += '"';
  return out;
}

namespace {

void write_text(CborWriter& out, std::string_view name, std::string_view text) {
  out.text(name);
  out.text(text);
}

void write_compression(CborWriter& out, const icd::MapData& data) {
  write_text(out, "compression", data.compression == icd::Compression::Gzip ? "gzip" : "none");
}

void write_type_and_name(CborWriter& out, const icd::MapUpdate& update) {
  write_text(out, "type", update.is_grid() ? "OccupancyGrid" : "PointCloud2");
  write_text(out, "name", icd::text_of(update.name));
}

/// Writes the message up to the data, from the data's size and the number of members in msg.
std::string write_up_to_data(std::size_t members, std::uint64_t size) {
  CborWriter out;
  out.map(3);
  out.text("msg");
  out.map(members);
  out.text("data");
  std::string before = out.finish().to_string();
  before += '\x5B';  // a byte string with its length in 8 bytes (RFC 8949 3)
  for (int shift = 56; shift >= 0; shift -= 8) before += static_cast<char>(size >> shift & 0xFF);
  return before;
}

}  // namespace

icd::ChunkedBytes write_map_update(const icd::MapUpdate& update) {
  CborWriter out;
  out.map(3);
  write_type_and_name(out, update);
  out.text("msg");
  std::visit(
      [&](const auto& msg) {
        out.map(count_written(msg) + 2);
        write_members(out, msg);
      },
      update.msg);
  out.text("data");
  out.byte_string(update.data.bytes);
  write_compression(out, update.data);
  return out.finish();
}

DataFirst write_data_first(const icd::MapUpdate& update) {
  const std::size_t members =
      std::visit([](const auto& msg) { return codec::count_written(msg) + 2; }, update.msg);
  CborWriter out;
  write_compression(out, update.data);
  std::visit([&](const auto& msg) { write_members(out, msg); }, update.msg);
  write_type_and_name(out, update);
  DataFirst written{.before = write_up_to_data(members, update.data.bytes.size()),
                    .after = out.finish().to_string()};
  assert(written.before.size() == DataFirst::kBefore);
  written.after += checksum_of(written.before, written.after);
  return written;
}

std::string checksum_of(std::string_view before, std::string_view after) {
  uLong sum = 0;
  for (const std::string_view part : {before, after})
    sum = crc32_z(sum, reinterpret_cast<const Bytef*>(part.data()), part.size());
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(sum >> shift & 0xFF);
  return bytes;
}

icd::ChunkedBytes write_state_update(const icd::StateUpdate& update) {
  static_assert(icd::count_of_members<icd::NamedPose>() == 2, "write each member");
  CborWriter out;
  out.map(2);
  write_header(out, update.header);
  out.text("poses");
  out.array(update.poses.size());
  for (const icd::NamedPose& named : update.poses) {
    out.map(3);
    write_text(out, "name", named.name.text());
    write_members(out, named.pose);
  }
  return out.finish();
}

icd::ChunkedBytes write_markers_update(const icd::MarkersUpdate& update) {
  CborWriter out;
  out.map(1);
  out.text("markers");
  out.array(update.markers.size());
  for (const icd::Marker& marker : update.markers) write_struct(out, marker);
  return out.finish();
}

}  // namespace adit::codec
