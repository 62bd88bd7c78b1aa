// POST /map/update (ICD 6.3, 6.4).
#include <algorithm>
#include <numeric>
#include <span>

#include "codec/cbor_value.hpp"
#include "codec/gzip.hpp"
#include "codec/members.hpp"
#include "codec/read.hpp"
#include "codec/splitter.hpp"
#include "codec/write.hpp"
#include "icd/require.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::codec {
namespace {

/// The value that a byte of a point belongs to.
struct Place {
  std::uint32_t begin = 0;
  std::uint32_t size = 0;  // in bytes; 0: padding
  friend bool operator==(const Place&, const Place&) = default;
};

/// False: the value overlaps another. Two names for one place are allowed.
bool take_place(std::span<Place> bytes, const Place& value) {
  const auto own = bytes.subspan(value.begin, value.size);
  if (std::ranges::all_of(own, [&](const Place& taken) { return taken == value; })) return true;
  if (std::ranges::any_of(own, [](const Place& taken) { return taken.size > 0; })) return false;
  std::ranges::fill(own, value);
  return true;
}

/// For each byte of a little-endian point, the index of the big-endian byte; padding stays. std::nullopt if
/// two values overlap, because no swapped point preserves both. Requires check(cloud).
std::optional<std::vector<std::uint32_t>> little_endian_order(const icd::PointCloud2& cloud) {
  std::vector<Place> bytes(cloud.point_step);
  std::vector<std::uint32_t> order(cloud.point_step);
  std::iota(order.begin(), order.end(), 0U);
  for (const icd::FieldSchema& field : cloud.fields) {
    const auto size = static_cast<std::uint32_t>(size_of(field.datatype));
    for (std::uint32_t i = 0; i < field.count; ++i) {
      const Place value{.begin = field.offset + i * size, .size = size};
      icd::require(value.begin <= cloud.point_step && size <= cloud.point_step - value.begin);
      if (!take_place(bytes, value)) return std::nullopt;
      for (std::uint32_t byte = 0; byte < size; ++byte) {
        order[value.begin + byte] = value.begin + size - 1 - byte;
      }
    }
  }
  return order;
}

/// Reorders the bytes of points; consumes `points`. Bytes after the last point stay. Requires !order.empty().
icd::ChunkedBytes reorder(icd::ChunkedBytes points, const std::vector<std::uint32_t>& order) {
  icd::require(!order.empty());
  icd::ChunkedBytes turned;
  std::vector<std::uint8_t> came, goes;  // whole points of one piece
  while (!points.empty()) {
    const auto piece = points.pop_front();
    came.insert(came.end(), piece->begin(), piece->end());
    const std::size_t whole = came.size() - came.size() % order.size();
    goes.resize(whole);
    for (std::size_t point = 0; point < whole; point += order.size()) {
      for (std::size_t byte = 0; byte < order.size(); ++byte) {
        goes[point + byte] = came[point + order[byte]];
      }
    }
    turned.append(goes);
    came.erase(came.begin(), came.begin() + static_cast<std::ptrdiff_t>(whole));
  }
  turned.append(came);
  return turned;
}

// The rest reads a map's data after the other fields were checked, and consumes it chunk by chunk.

constexpr std::string_view kPath = "msg.data";

/// Counts and checks cells during inflation.
class CellCheck {
 public:
  explicit CellCheck(const icd::OccupancyGrid& grid) : grid_(grid) {}

  icd::Checked<void> check(std::span<const std::uint8_t> cells) {
    const std::size_t expected = icd::cells_of(grid_);
    if (cells.size() > expected - taken_) {  // at once, so that a gzip bomb is not inflated further
      return icd::unprocessable("msg.info.width: expected ", grid_.width, " x ", grid_.height, " = ",
                                expected, " bytes of data, got more");
    }
    auto checked = icd::check_cells(cells, taken_);
    taken_ += cells.size();
    return checked;
  }

  icd::Checked<void> finish() const { return icd::check_size(grid_, taken_); }

 private:
  const icd::OccupancyGrid& grid_;
  std::size_t taken_ = 0;
};

icd::MapData press_grid(Gzipper& gzipper, const icd::OccupancyGrid& grid) {
  return {.bytes = gzipper.finish(), .compression = icd::Compression::Gzip, .raw_size = icd::cells_of(grid)};
}

/// Whether the header has no name, comment or checksum (RFC 1952 2.3.1), which other readers may not expect.
bool has_plain_head(const icd::ChunkedBytes& member) {
  constexpr std::size_t kFlags = 3;
  const auto& first = *member.chunks().front();
  return first.size() > kFlags && first[kFlags] == 0;
}

/// Checks the cells first. Keeps the sender's member if it is smaller, because many senders compress better.
/// If the data claims another size, it has several members or is invalid: the first pass only checks it.
icd::Checked<icd::MapData> read_gzipped_cells(const icd::OccupancyGrid& grid, icd::ChunkedBytes data,
                                              const icd::Rules& rules) {
  for (bool is_kept = claimed_size(data) == icd::cells_of(grid);; is_kept = true) {
    CellCheck check(grid);
    Gzipper gzipper(GzipStrategy::Runs);
    const auto sink = [&](std::span<const std::uint8_t> cells) {
      auto checked = check.check(cells);
      if (checked && is_kept) gzipper.feed(cells);
      return checked;
    };
    const auto inflated = ADIT_TRY(gunzip(data, rules.map_bytes, kPath, sink));
    ADIT_TRY(check.finish());
    if (!is_kept) continue;
    icd::MapData ours = press_grid(gzipper, grid);
    const bool is_one = inflated.members == 1;  // a Command Post hangs at a second member
    if (is_one && data.size() < ours.bytes.size() && has_plain_head(data)) ours.bytes = std::move(data);
    return ours;
  }
}

/// ROS's layout of an organised cloud, which the ICD does not have. All 0: not in the message.
struct CloudRows {
  std::uint64_t width = 0, height = 0;  // points in a row, and number of rows
  std::uint64_t row_step = 0;           // bytes from row to row
};

bool are_padded(const CloudRows& rows, const icd::PointCloud2& cloud, std::size_t bytes) {
  return rows.height > 1 && rows.row_step > rows.width * cloud.point_step &&
         rows.row_step * rows.height == bytes;
}

icd::Checked<void> check_points(const icd::PointCloud2& cloud, const CloudRows& rows, std::size_t bytes) {
  return are_padded(rows, cloud, bytes) ? icd::Checked<void>() : icd::check_size(cloud, bytes);
}

/// The first `row_size` of each `row_step` bytes.
icd::ChunkedBytes strip_row_padding(icd::ChunkedBytes data, std::size_t row_size, std::size_t row_step) {
  icd::ChunkedBytes points;
  std::size_t at = 0;  // position in the row
  while (!data.empty()) {
    const auto chunk = data.pop_front();
    for (auto rest = *chunk; !rest.empty();) {
      const auto piece = rest.first(std::min(rest.size(), row_step - at));
      points.append(piece.first(std::min(piece.size(), row_size - std::min(row_size, at))));
      rest = rest.subspan(piece.size());
      at = (at + piece.size()) % row_step;
    }
  }
  return points;
}

icd::Checked<icd::ChunkedBytes> inflated_points(const icd::PointCloud2& cloud, const CloudRows& rows,
                                                const icd::ChunkedBytes& data, const icd::Rules& rules) {
  for (std::size_t size = claimed_size(data);;) {  // in the second pass, the true size of several members
    const bool is_kept = size <= rules.map_bytes && check_points(cloud, rows, size);  // as for a grid
    icd::ChunkedBytes points;
    const auto sink = [&](std::span<const std::uint8_t> piece) -> icd::Checked<void> {
      if (is_kept && piece.size() <= size - points.size()) points.append(piece);
      return {};
    };
    const auto inflated = ADIT_TRY(gunzip(data, rules.map_bytes, kPath, sink));
    ADIT_TRY(check_points(cloud, rows, inflated.size));
    if (points.size() == inflated.size) return points;
    size = inflated.size;
  }
}

/// ICD 6.3.1: width * height cells, each 0 to 100 or 255, left as one gzip member.
icd::Checked<icd::MapData> read_cells(const icd::OccupancyGrid& grid, icd::ChunkedBytes data,
                                      icd::Compression compression, const icd::Rules& rules) {
  if (compression == icd::Compression::Gzip) return read_gzipped_cells(grid, std::move(data), rules);
  ADIT_TRY(icd::check_size(grid, data.size()));
  std::size_t at = 0;
  for (const auto& chunk : data.chunks()) {
    ADIT_TRY(icd::check_cells(*chunk, at));
    at += chunk->size();
  }
  Gzipper gzipper(GzipStrategy::Runs);
  while (!data.empty()) gzipper.feed(*data.pop_front());
  return press_grid(gzipper, grid);
}

/// The same for cells compressed on arrival.
icd::Checked<icd::MapData> read_pressed_cells(const icd::OccupancyGrid& grid, icd::ChunkedBytes data,
                                              icd::Compression compression, const PressedCells& pressed) {
  if (compression == icd::Compression::Gzip) {  // gunzip()'s error: the cells do not begin like gzip
    return icd::unprocessable(kPath, ": expected a gzip member, got ",
                              pressed.count < 2 ? "one that is cut short" : "incorrect header check");
  }
  ADIT_TRY(icd::check_size(grid, pressed.count));
  if (!pressed.checked) return std::unexpected(pressed.checked.error());
  return icd::MapData{
      .bytes = std::move(data), .compression = icd::Compression::Gzip, .raw_size = pressed.count};
}

/// ICD 6.3.2: a whole number of points, unchanged, without padding at row ends. Drivers fill `rows` wrongly
/// (row_step 0, size of all data, number of points), so rows count only if padded and of the data's size.
icd::Checked<icd::MapData> read_points(const icd::PointCloud2& cloud, const CloudRows& rows,
                                       icd::ChunkedBytes data, icd::Compression compression,
                                       const icd::Rules& rules) {
  icd::ChunkedBytes points = std::move(data);
  if (compression == icd::Compression::Gzip) {
    auto inflated = ADIT_TRY(inflated_points(cloud, rows, points, rules));
    points = std::move(inflated);
  }
  if (points.size() > rules.map_bytes) {
    return std::unexpected(
        icd::Refusal{.status = icd::Status::ContentTooLarge,
                     .sentence = icd::sentence(kPath, ": expected at most ", rules.map_bytes,
                                               " bytes (the setting rules.map_bytes), got ", points.size()),
                     .setting = "rules.map_bytes"});
  }
  ADIT_TRY(check_points(cloud, rows, points.size()));
  if (are_padded(rows, cloud, points.size()))
    points = strip_row_padding(std::move(points), rows.width * cloud.point_step, rows.row_step);
  const std::size_t size = points.size();
  return icd::MapData{.bytes = std::move(points), .compression = icd::Compression::None, .raw_size = size};
}

std::optional<icd::RobotName> read_map_name(const Field& name, const icd::Rules& rules) {
  if (name.is_absent() || name.is_empty_text()) return std::nullopt;  // merged
  return read_robot_name(name, rules);
}

icd::Compression read_compression(const Field& field, DataForm form) {
  if (field.is_absent()) return icd::Compression::None;
  const std::string_view scheme = field.text();
  if (icd::equals_ignoring_case(scheme, "none")) return icd::Compression::None;
  if (!icd::equals_ignoring_case(scheme, "gzip"))
    field.refuse("expected \"none\" or \"gzip\", got ", icd::quote_text(scheme));
  if (form == DataForm::Integers) field.refuse("expected \"none\" with data as an array, got \"gzip\"");
  return icd::Compression::Gzip;
}

void require_data(const Field& data) {
  if (!data.is<Value::SplitOut>()) data.refuse_kind("a base64 string (JSON) or a byte string (CBOR)");
}

template <class Map>
Map read_msg(const Field& msg, const icd::Rules& rules) {
  Map map;
  read_members(msg, map, rules);
  if (!msg.reading().has_refusal()) msg.reading().keep(icd::check(map, rules));
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
  const Field msg = body.member("msg");
  if (kind != "OccupancyGrid" && kind != "PointCloud2") {
    type.refuse("expected \"OccupancyGrid\" or \"PointCloud2\", got ", icd::quote_text(kind));
    if (msg.is_absent()) msg.refuse_kind("an object");
    return reading.outcome(std::move(update));  // the type decides which members msg needs
  }
  update.name = read_map_name(body.member("name"), rules);
  if (kind == "PointCloud2") {
    update.msg = read_msg<icd::PointCloud2>(msg, rules);
  } else {
    update.msg = read_msg<icd::OccupancyGrid>(msg, rules);
  }
  require_data(msg.member("data"));
  compression = read_compression(msg.member("compression"), document.data_form);
  return reading.outcome(std::move(update));
}

/// Never refuses.
CloudRows read_rows(const Value& root) {
  Reading reading;
  const Field body(root, reading);
  const Field msg = body.member("msg");
  const auto number = [&](std::string_view name) { return msg.member(name).integer<std::uint32_t>(); };
  const CloudRows rows{.width = number("width"), .height = number("height"), .row_step = number("row_step")};
  return reading.has_refusal() ? CloudRows{} : rows;
}

/// ICD 6.3.2: points are sent little-endian, because one server reorders those of a big-endian cloud with an
/// origin wrongly. If the values cannot be reordered, the points are sent as received.
icd::Checked<icd::MapData> to_little_endian(icd::PointCloud2& cloud, icd::MapData data) {
  const auto order = little_endian_order(cloud);
  if (!order && cloud.origin) {
    return icd::unprocessable(
        "msg.is_bigendian: expected false for a cloud that has an origin and overlapping fields, got true");
  }
  if (!order) return data;
  cloud.is_bigendian = false;
  data.bytes = reorder(std::move(data.bytes), *order);
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

/// Checks Adit's stored form (read.hpp: grids as gzip, clouds raw) as far as possible without the data.
icd::Checked<void> check_form(const icd::MapUpdate& map) {
  const auto* const cloud = std::get_if<icd::PointCloud2>(&map.msg);
  const auto expected = cloud == nullptr ? icd::Compression::Gzip : icd::Compression::None;
  if (map.data.compression != expected)
    return icd::unprocessable("msg.compression: expected the compression of stored maps");
  return cloud == nullptr ? icd::Checked<void>() : icd::check_size(*cloud, map.data.bytes.size());
}

}  // namespace

icd::Checked<void> check_data(const icd::MapUpdate& map) {
  const auto* const grid = std::get_if<icd::OccupancyGrid>(&map.msg);
  if (grid == nullptr) return icd::check_size(std::get<icd::PointCloud2>(map.msg), map.data.bytes.size());
  CellCheck check(*grid);
  auto read =
      for_each_piece(map.data, [&](std::span<const std::uint8_t> piece) { return check.check(piece); });
  return read ? check.finish() : read;
}

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
    auto turned_data = ADIT_TRY(to_little_endian(*cloud, std::move(data)));
    data = std::move(turned_data);
  }
  update->data = std::move(data);
  return update;
}

}  // namespace adit::codec
