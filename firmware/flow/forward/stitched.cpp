#include "forward/stitched.hpp"

#include <algorithm>
#include <utility>
#include <variant>
#include <vector>

#include "codec/gzip.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "pack/pack.hpp"
#include "pack/stitch.hpp"
#include "queues/lattice.hpp"

namespace adit::forward {
namespace {

/// Its cells are only in parts.
bool is_to_be_stitched(const queues::QueuedMap& waiting) {
  return waiting.map.is_grid() && !waiting.parts.empty() && waiting.map.data.bytes.empty();
}

/// nullopt: damaged data.
std::optional<queues::Ground> overlay(const queues::Ground& under, const icd::MapData& data) {
  queues::Drawing drawing(under);
  std::size_t left = static_cast<std::size_t>(under.cells.width * under.cells.height);
  const auto read =
      codec::for_each_piece(data, [&](std::span<const std::uint8_t> piece) -> icd::Checked<void> {
        if (piece.size() > left) return icd::refuse(icd::Status::ServiceUnavailable, "it has too many cells");
        left -= piece.size();
        drawing.feed(piece);
        return {};
      });
  return read && left == 0 ? std::optional(drawing.finish()) : std::nullopt;
}

/// The points of a cloud, or the rows of a grid, that are sent next.
icd::Checked<icd::MapData> piece_of(const queues::QueuedMap& waiting) {
  std::size_t skip = waiting.piece.at, left = queues::next_size(waiting);
  icd::MapData piece{{}, icd::Compression::None, left};
  ADIT_TRY(
      codec::for_each_piece(waiting.map.data, [&](std::span<const std::uint8_t> bytes) -> icd::Checked<void> {
        const std::size_t skipped = std::min(skip, bytes.size());
        bytes = bytes.subspan(skipped, std::min(left, bytes.size() - skipped));
        piece.bytes.append(bytes);
        skip -= skipped;
        left -= bytes.size();
        return {};
      }));
  return piece;
}

double unit_of(queues::Precision precision) {
  if (precision == queues::Precision::Millimetre) return pack::kMillimetre;
  return precision == queues::Precision::EightMillimetres ? pack::kEightMillimetres : 0;
}

/// A cloud without one is not accepted, but a piece of a cloud may have none.
bool has_no_valid_point(const icd::MapUpdate& piece) {
  const auto* const cloud = std::get_if<icd::PointCloud2>(&piece.msg);
  return cloud != nullptr && pack::remove_invalid_points(*cloud, piece.data).raw_size == 0;
}

/// The origin shows it.
bool was_rounded(const icd::MapUpdate& before, const icd::MapUpdate& after) {
  const auto* const cloud = std::get_if<icd::PointCloud2>(&after.msg);
  return cloud != nullptr && cloud->origin != std::get<icd::PointCloud2>(before.msg).origin;
}

}  // namespace

PackedMap pack_map(const queues::QueuedMap& waiting, const Packing& packing) {
  auto whole = assemble(waiting);
  if (!whole) return {};
  PackedMap packed;
  if (waiting.piece.size > 0 && has_no_valid_point(*whole)) {
    packed.has_no_valid_point = true;
    return packed;
  }
  if (waiting.ground) packed.drawn = overlay(*waiting.ground, whole->data);
  if (!whole->is_grid()) packed.points_size = whole->data.raw_size;
  const bool is_as_it_is = waiting.packing == queues::PackingRule::LastAsItIs;
  if (!is_as_it_is && whole->is_grid() && whole->data.compression == icd::Compression::None) {
    whole->data.bytes = codec::gzip(std::move(whole->data.bytes), codec::GzipStrategy::Runs);
    whole->data.compression = icd::Compression::Gzip;
  }
  const double unit = unit_of(waiting.precision);
  const bool is_rounded = unit > 0 && whole->data.raw_size <= pack::kMostPacked;  // by Full alone
  const pack::Choice choice = is_as_it_is  ? pack::Choice{.effort = pack::Effort::None}
                              : is_rounded ? pack::Choice{}
                                           : pack::effort_for(*whole, packing.hurry);
  packed.effort = choice.effort;
  packed.expected = pack::seconds_for(packed.effort, *whole);
  icd::MapUpdate map = *std::move(whole);
  if (map.is_grid()) {
    auto cells = pack::pack_cells(map.data, packed.effort);
    const bool is_doubtful = !cells || (waiting.ground && !packed.drawn);
    if (is_doubtful && !codec::check_data(map)) return {};
    if (cells) map.data = *std::move(cells);
  } else {
    map = pack::pack(std::move(map), {packing.arranges_clouds, unit, packed.effort});
  }
  if (was_rounded(waiting.map, map)) packed.precision = waiting.precision;
  packed.body = codec::write_map_update(map);
  packed.full_size = packed.effort == pack::Effort::Full
                         ? packed.body.size()
                         : static_cast<std::size_t>(choice.full_to * static_cast<double>(packed.points_size));
  if (is_to_be_stitched(waiting)) packed.stitched = std::move(map.data);
  return packed;
}

icd::Checked<icd::MapUpdate> assemble(const queues::QueuedMap& waiting) {
  icd::MapUpdate whole = waiting.map;
  if (waiting.piece.size > 0) whole.data = ADIT_TRY(piece_of(waiting));
  if (whole.is_grid()) whole.msg = queues::rows_of(waiting);
  if (!is_to_be_stitched(waiting)) return whole;
  const auto& grid = std::get<icd::OccupancyGrid>(whole.msg);
  std::vector<pack::Tile> tiles;
  for (const queues::QueuedMap& part : waiting.parts) {
    const auto cells = queues::cells_in(grid, std::get<icd::OccupancyGrid>(part.map.msg));
    if (!cells) return icd::refuse(icd::Status::ServiceUnavailable, "it is of another lattice");
    tiles.push_back({part.map.data, static_cast<std::size_t>(cells->x), static_cast<std::size_t>(cells->y),
                     static_cast<std::size_t>(cells->width), static_cast<std::size_t>(cells->height)});
  }
  auto data = ADIT_TRY(
      pack::stitch(grid.width, grid.height, tiles,
                   waiting.has_gaps ? queues::cells_under(*waiting.ground) : std::vector<std::uint8_t>{}));
  whole.data = std::move(data);
  return whole;
}

}  // namespace adit::forward
