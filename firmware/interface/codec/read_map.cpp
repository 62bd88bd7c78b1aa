// POST /map/update (ICD 6.3, 6.4).
#include <algorithm>

#include "codec/cbor_value.hpp"
#include "codec/members.hpp"
#include "codec/read.hpp"
#include "codec/read_map_data.hpp"
#include "codec/splitter.hpp"
#include "codec/write.hpp"
#include "icd/require.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::codec {
namespace {

std::optional<icd::RobotName> read_map_name(const Field& name, const icd::Rules& rules) {
  if (name.is_absent() || name.is_empty_text()) return std::nullopt;  // merged
  return read_robot_name(name, rules);
}

icd::Compression read_compression(const Field& field, DataForm form) {
  if (field.is_absent()) return icd::Compression::None;
  const std::string_view scheme = field.text();
  if (icd::same_but_for_case(scheme, "none")) return icd::Compression::None;
  if (!icd::same_but_for_case(scheme, "gzip"))
    field.refuse("expected \"none\" or \"gzip\", got ", icd::in_quotes(scheme));
  if (form == DataForm::Integers) field.refuse("expected \"none\" with data as an array, got \"gzip\"");
  return icd::Compression::Gzip;
}

void check_data_is_there(const Field& data) {
  if (!data.is<Value::SplitOut>()) data.refuse_kind("a base64 string (JSON) or a byte string (CBOR)");
}

/// Reads a grid or cloud and checks its rules.
template <class Map>
Map read_msg(const Field& msg, const icd::Rules& rules) {
  Map map;
  read_members(msg, map, rules);
  if (!msg.reading().refused()) msg.reading().keep(icd::check(map, rules));
  return map;
}

/// Reads all but the data. Sets `compression`.
icd::Checked<icd::MapUpdate> read_structure(const Document& document, const icd::Rules& rules,
                                            icd::Compression& compression) {
  Reading reading;
  icd::MapUpdate update;
  const Field body(document.root, reading);
  const Field type = body.member("type");
  const std::string_view kind = type.text();
  if (kind != "OccupancyGrid" && kind != "PointCloud2") {
    type.refuse("expected \"OccupancyGrid\" or \"PointCloud2\", got ", icd::in_quotes(kind));
  }
  update.name = read_map_name(body.member("name"), rules);
  const Field msg = body.member("msg");
  if (kind == "PointCloud2") {
    update.msg = read_msg<icd::PointCloud2>(msg, rules);
  } else {
    update.msg = read_msg<icd::OccupancyGrid>(msg, rules);
  }
  check_data_is_there(msg.member("data"));
  compression = read_compression(msg.member("compression"), document.data_form);
  return reading.outcome(std::move(update));
}

/// Never refuses.
CloudRows read_rows(const Value& root) {
  Reading reading;
  const Field body(root, reading);
  const Field msg = body.member("msg");
  const auto number = [&](std::string_view name) { return msg.member(name).whole<std::uint32_t>(); };
  const CloudRows rows{.width = number("width"), .height = number("height"), .row_step = number("row_step")};
  return reading.refused() ? CloudRows{} : rows;
}

/// ICD 6.3.2: points are sent little-endian, because one server reorders those of a big-endian cloud with an
/// origin wrongly. If the values cannot be reordered, the points are sent as received.
icd::Checked<icd::MapData> turned(icd::PointCloud2& cloud, icd::MapData data) {
  const auto order = little_endian_order(cloud);
  if (!order && cloud.origin) {
    return icd::unprocessable(
        "msg.is_bigendian: expected false for a cloud that has an origin and overlapping fields, got true");
  }
  if (!order) return data;
  cloud.is_bigendian = false;
  data.bytes = in_order(std::move(data.bytes), *order);
  return data;
}

icd::Checked<icd::MapData> read_data(const icd::MapUpdate& update, Document document,
                                     icd::Compression compression, const icd::Rules& rules) {
  if (!update.is_grid()) {
    icd::require(!document.pressed);  // the type is known first and may occur once
    return read_points(std::get<icd::PointCloud2>(update.msg), read_rows(document.root),
                       std::move(document.data), compression, rules);
  }
  const auto& grid = std::get<icd::OccupancyGrid>(update.msg);
  return document.pressed ? read_pressed_cells(grid, std::move(document.data), compression, *document.pressed)
                          : read_cells(grid, std::move(document.data), compression, rules);
}

/// Checks Adit's stored form (read.hpp: grids as gzip, clouds raw) as far as possible without reading the
/// data.
icd::Checked<void> check_form(const icd::MapUpdate& map) {
  const auto* const cloud = std::get_if<icd::PointCloud2>(&map.msg);
  const auto expected = cloud == nullptr ? icd::Compression::Gzip : icd::Compression::None;
  if (map.data.compression != expected)
    return icd::unprocessable("msg.compression: expected the compression of stored maps");
  return cloud == nullptr ? icd::Checked<void>() : icd::check_size(*cloud, map.data.bytes.size());
}

}  // namespace

std::uint64_t data_after(std::string_view before) {
  icd::require(before.size() == DataFirst::kBefore);
  std::uint64_t size = 0;
  for (const char byte : before.substr(before.size() - sizeof size))
    size = size << 8 | static_cast<std::uint8_t>(byte);
  return size;
}

icd::Checked<icd::MapUpdate> read_data_first(std::string_view before, icd::ChunkedBytes data,
                                             std::string_view after, const icd::Rules& rules) {
  const std::string_view checksum = after.substr(after.size() - std::min(after.size(), DataFirst::kChecksum));
  after.remove_suffix(checksum.size());
  if (checksum != checksum_of(before, after)) return icd::unprocessable("the message is damaged");
  std::string without_data(before.substr(0, before.size() - sizeof(std::uint64_t)));
  without_data.append(sizeof(std::uint64_t), '\0').append(after);
  // The text is as written and well-formed. The checks of a client's message would take a third of the time.
  Document document{
      .root = cbor_value(without_data), .data = {}, .data_form = DataForm::ByteString, .pressed = {}};
  mark_split_out(document.root);
  auto compression = icd::Compression::None;
  auto map = read_structure(document, rules, compression);
  if (!map) return map;
  const auto* const grid = std::get_if<icd::OccupancyGrid>(&map->msg);
  const std::size_t raw_size = grid == nullptr ? data.size() : icd::cells_of(*grid);
  map->data = {.bytes = std::move(data), .compression = compression, .raw_size = raw_size};
  ADIT_TRY(check_form(*map));
  return map;
}

icd::Checked<icd::MapUpdate> read_map_update(Document document, const icd::Rules& rules) {
  auto compression = icd::Compression::None;
  auto update = read_structure(document, rules, compression);
  if (!update) return update;
  auto data = ADIT_TRY(read_data(*update, std::move(document), compression, rules));
  if (auto* cloud = std::get_if<icd::PointCloud2>(&update->msg); cloud != nullptr && cloud->is_bigendian) {
    auto turned_data = ADIT_TRY(turned(*cloud, std::move(data)));
    data = std::move(turned_data);
  }
  update->data = std::move(data);
  return update;
}

}  // namespace adit::codec
