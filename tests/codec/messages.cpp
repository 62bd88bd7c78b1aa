#include "codec/messages.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>

namespace adit::codec::test {
namespace {

json pose(double x) {
  return {{"position", {{"x", x}, {"y", -2.5}, {"z", 0.25}}},
          {"orientation", {{"x", 0.0}, {"y", 0.0}, {"z", 0.6}, {"w", 0.8}}}};
}

json header() {
  return {{"stamp", 721.4}, {"frame_id", "darpa"}};
}

/// Replaces each binary by a base64 string.
json with_base64(json value) {
  if (value.is_binary()) return base64(value.get_binary());
  if (value.is_structured()) {
    for (auto& child : value) child = with_base64(child);
  }
  return value;
}

}  // namespace

json quaternion(double x, double y, double z, double w) {
  return {{"x", x}, {"y", y}, {"z", z}, {"w", w}};
}

json good_grid() {
  return {{"type", "OccupancyGrid"},
          {"name", "husky_01"},
          {"msg",
           {{"header", header()},
            {"info", {{"resolution", 0.2}, {"width", 4}, {"height", 3}, {"origin", pose(1.5)}}},
            {"data", json::binary({0, 1, 50, 100, 255, 255, 0, 0, 100, 99, 255, 1})},
            {"compression", "none"}}}};
}

json good_cloud() {
  const auto field = [](const char* name, int offset, int datatype) {
    return json{{"name", name}, {"offset", offset}, {"datatype", datatype}, {"count", 1}};
  };
  return {{"type", "PointCloud2"},
          {"name", "husky_01"},
          {"msg",
           {{"header", header()},
            {"origin", pose(1.5)},
            {"fields", {field("x", 0, 7), field("y", 4, 7), field("z", 8, 7), field("rgba", 12, 6)}},
            {"is_bigendian", false},
            {"point_step", 16},
            {"data", json::binary(Bytes(32, 0x41))},
            {"compression", "none"}}}};
}

json good_state() {
  json one = pose(1);
  one["name"] = "husky_01";
  json two = pose(2);
  two["name"] = "drone_02";
  return {{"header", header()}, {"poses", {one, two}}};
}

json good_markers() {
  const json one = {{"header", header()},
                    {"ns", "artifacts"},
                    {"id", 7},
                    {"type", 2},
                    {"action", 0},
                    {"pose", pose(3)},
                    {"scale", {{"x", 1.0}, {"y", 1.0}, {"z", 1.0}}},
                    {"color", {{"r", 1.0}, {"g", 0.5}, {"b", 0.0}, {"a", 1.0}}},
                    {"lifetime", 10.5},
                    {"text", "Backpack"}};
  const json two = {{"action", 2}, {"ns", "artifacts"}, {"id", 8}};
  return {{"markers", {one, two}}};
}

json good_report() {
  return {{"x", 1011.242}, {"y", -244.433}, {"z", -10.011}, {"type", "backpack"}};
}

std::string base64(const Bytes& bytes) {
  static constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = bytes[i] << 16U;
    if (i + 1 < bytes.size()) group |= bytes[i + 1] << 8U;
    if (i + 2 < bytes.size()) group |= bytes[i + 2];
    text += kAlphabet[group >> 18U];
    text += kAlphabet[(group >> 12U) & 63U];
    text += i + 1 < bytes.size() ? kAlphabet[(group >> 6U) & 63U] : '=';
    text += i + 2 < bytes.size() ? kAlphabet[group & 63U] : '=';
  }
  return text;
}

std::string as_json(const json& message) {
  return with_base64(message).dump();
}

std::string as_cbor(const json& message) {
  const Bytes bytes = json::to_cbor(message);
  return {bytes.begin(), bytes.end()};
}

Bytes compressed(const Bytes& bytes, int window) {
  z_stream zlib{};
  EXPECT_EQ(deflateInit2(&zlib, 9, Z_DEFLATED, window, 9, Z_DEFAULT_STRATEGY), Z_OK);
  Bytes out(deflateBound(&zlib, bytes.size()) + 32);
  zlib.next_in = const_cast<Bytef*>(bytes.data());
  zlib.avail_in = static_cast<uInt>(bytes.size());
  zlib.next_out = out.data();
  zlib.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&zlib, Z_FINISH), Z_STREAM_END);
  out.resize(zlib.total_out);
  deflateEnd(&zlib);
  return out;
}

Bytes only_member(const Bytes& bytes) {
  z_stream zlib{};
  EXPECT_EQ(inflateInit2(&zlib, 31), Z_OK);
  zlib.next_in = const_cast<Bytef*>(bytes.data());
  zlib.avail_in = static_cast<uInt>(bytes.size());
  Bytes out;
  int code = Z_OK;
  while (code == Z_OK) {
    Bytes piece(65536);
    zlib.next_out = piece.data();
    zlib.avail_out = static_cast<uInt>(piece.size());
    code = inflate(&zlib, Z_NO_FLUSH);
    out.insert(out.end(), piece.begin(), piece.end() - zlib.avail_out);
  }
  EXPECT_EQ(code, Z_STREAM_END) << "no whole gzip member";
  EXPECT_EQ(zlib.avail_in, 0U) << "bytes after the gzip member";
  inflateEnd(&zlib);
  return out;
}

Bytes raw_data(const icd::MapData& data) {
  const Bytes bytes = data.bytes.to_vector();
  return data.compression == icd::Compression::Gzip ? only_member(bytes) : bytes;
}

icd::MapUpdate little_endian(icd::MapUpdate map) {
  auto* const cloud = std::get_if<icd::PointCloud2>(&map.msg);
  if (cloud == nullptr || !cloud->is_bigendian) return map;
  Bytes points = raw_data(map.data);
  for (std::size_t point = 0; point < points.size(); point += cloud->point_step) {
    for (const icd::FieldSchema& field : cloud->fields) {
      const auto size = static_cast<std::ptrdiff_t>(icd::size_of(field.datatype));
      auto value = points.begin() + static_cast<std::ptrdiff_t>(point + field.offset);
      for (std::uint32_t i = 0; i < field.count; ++i, value += size) std::reverse(value, value + size);
    }
  }
  cloud->is_bigendian = false;
  map.data = {.bytes = icd::ChunkedBytes(points), .compression = {}, .raw_size = points.size()};
  return map;
}

void expect_same(const icd::MapUpdate& map, const icd::MapUpdate& expected) {
  EXPECT_EQ(map.name, expected.name);
  EXPECT_EQ(map.msg, expected.msg);
  EXPECT_EQ(map.data.raw_size, expected.data.raw_size);
  EXPECT_EQ(raw_data(map.data), raw_data(expected.data));
}

}  // namespace adit::codec::test
