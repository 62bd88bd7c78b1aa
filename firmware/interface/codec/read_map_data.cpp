#include "codec/read_map_data.hpp"

#include <algorithm>
#include <numeric>
#include <span>

#include "codec/gzip.hpp"
#include "codec/read.hpp"
#include "icd/require.hpp"
#include "icd/sentence.hpp"
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

}  // namespace

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

icd::ChunkedBytes in_order(icd::ChunkedBytes points, const std::vector<std::uint32_t>& order) {
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

namespace {

constexpr std::string_view kPath = "msg.data";

/// Counts and checks cells during inflation.
class CellCheck {
 public:
  explicit CellCheck(const icd::OccupancyGrid& grid) : grid_(grid) {}

  icd::Checked<void> take(std::span<const std::uint8_t> cells) {
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

/// A grid's data in the sent form.
icd::MapData pressed(Gzipper& gzipper, const icd::OccupancyGrid& grid) {
  return {.bytes = gzipper.finish(), .compression = icd::Compression::Gzip, .raw_size = icd::cells_of(grid)};
}

/// Whether the header has no name, comment or checksum (RFC 1952 2.3.1), which other readers may not expect.
bool has_plain_head(const icd::ChunkedBytes& member) {
  constexpr std::size_t kFlags = 3;
  const auto& first = *member.chunks().front();
  return first.size() > kFlags && first[kFlags] == 0;
}

/// Checks the cells first. Preserves the sender's member if it is smaller, because many senders compress
/// better. If the data claims another size, it has several members or is invalid: the first pass then only
/// checks it.
icd::Checked<icd::MapData> read_gzipped_cells(const icd::OccupancyGrid& grid, icd::ChunkedBytes data,
                                              const icd::Rules& rules) {
  for (bool is_kept = claimed_size(data) == icd::cells_of(grid);; is_kept = true) {
    CellCheck check(grid);
    Gzipper gzipper(GzipStrategy::Runs);
    const auto sink = [&](std::span<const std::uint8_t> cells) {
      auto checked = check.take(cells);
      if (checked && is_kept) gzipper.feed(cells);
      return checked;
    };
    const auto inflated = ADIT_TRY(gunzip(data, rules.map_bytes, kPath, sink));
    ADIT_TRY(check.finish());
    if (!is_kept) continue;
    icd::MapData ours = pressed(gzipper, grid);
    const bool is_one = inflated.members == 1;  // a Command Post hangs at a second member
    if (is_one && data.size() < ours.bytes.size() && has_plain_head(data)) ours.bytes = std::move(data);
    return ours;
  }
}

bool are_padded(const CloudRows& rows, const icd::PointCloud2& cloud, std::size_t bytes) {
  return rows.height > 1 && rows.row_step > rows.width * cloud.point_step &&
         rows.row_step * rows.height == bytes;
}

icd::Checked<void> check_points(const icd::PointCloud2& cloud, const CloudRows& rows, std::size_t bytes) {
  return are_padded(rows, cloud, bytes) ? icd::Checked<void>() : icd::check_size(cloud, bytes);
}

/// The first `row_size` of each `row_step` bytes.
icd::ChunkedBytes without_row_padding(icd::ChunkedBytes data, std::size_t row_size, std::size_t row_step) {
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

}  // namespace

icd::Checked<void> check_data(const icd::MapUpdate& map) {
  const auto* const grid = std::get_if<icd::OccupancyGrid>(&map.msg);
  if (grid == nullptr) return icd::check_size(std::get<icd::PointCloud2>(map.msg), map.data.bytes.size());
  CellCheck check(*grid);
  auto read =
      for_each_piece(map.data, [&](std::span<const std::uint8_t> piece) { return check.take(piece); });
  return read ? check.finish() : read;
}

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
  return pressed(gzipper, grid);
}

icd::Checked<icd::MapData> read_pressed_cells(const icd::OccupancyGrid& grid, icd::ChunkedBytes data,
                                              icd::Compression compression, const PressedCells& pressed) {
  if (compression == icd::Compression::Gzip) {  // gunzip()'s error, because these cells do not begin like
                                                // gzip
    return icd::unprocessable(kPath, ": expected a gzip member, got ",
                              pressed.count < 2 ? "one that is cut short" : "incorrect header check");
  }
  ADIT_TRY(icd::check_size(grid, pressed.count));
  if (!pressed.checked) return std::unexpected(pressed.checked.error());
  return icd::MapData{
      .bytes = std::move(data), .compression = icd::Compression::Gzip, .raw_size = pressed.count};
}

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
    points = without_row_padding(std::move(points), rows.width * cloud.point_step, rows.row_step);
  const std::size_t size = points.size();
  return icd::MapData{.bytes = std::move(points), .compression = icd::Compression::None, .raw_size = size};
}

}  // namespace adit::codec
