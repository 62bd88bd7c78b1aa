#include "api/map_json.hpp"

#include <array>

#include "icd/text.hpp"

namespace adit::api {
namespace {

extern const codec::Row kTile, kArea, kHeights, kFiner, kLayer;

}  // namespace
}  // namespace adit::api

namespace adit::codec {

template <>
struct KindOf<picture::TileView> : KindOfRow<picture::TileView, api::kTile> {};
template <>
struct KindOf<picture::Area> : KindOfRow<picture::Area, api::kArea> {};
template <>
struct KindOf<picture::Heights> : KindOfRow<picture::Heights, api::kHeights> {};
template <>
struct KindOf<picture::FinerLevels> : KindOfRow<picture::FinerLevels, api::kFiner> {};
template <>
struct KindOf<picture::LayerView> : KindOfRow<picture::LayerView, api::kLayer> {};

template <>
struct KindOf<picture::LayerKind> : WriteOnly {
  static Value write(picture::LayerKind kind) {
    return {kind == picture::LayerKind::Grid ? "grid" : "cloud"};
  }
  static constexpr Schema schema = KindOf<std::string>::schema;
};

/// In CSS form: "#c8d2da".
template <>
struct KindOf<picture::Colour> : WriteOnly {
  static Value write(const picture::Colour& colour) {
    return {"#" + icd::hex(std::array{colour.red, colour.green, colour.blue})};
  }
  static constexpr Schema schema = {
      .type = "string", .more = R"("pattern":"^#[0-9a-f]{6}$")", .name = "Colour"};
};

}  // namespace adit::codec

namespace adit::api {
namespace {

using codec::member;
using codec::Member;
using codec::Row;
using picture::LayerView;
using picture::TileView;

constexpr Member kTileMembers[] = {
    member<&TileView::at, &picture::TileIndex::level>("level"),
    member<&TileView::at, &picture::TileIndex::x>("x"),
    member<&TileView::at, &picture::TileIndex::y>("y"),
    member<&TileView::first>("first", "seconds since 1970"),
    member<&TileView::stamp>("stamp", "seconds since 1970"),
    member<&TileView::version>("version"),
    member<&TileView::blank>("blank", "whether the tile was deleted since: 404 now"),
};
constexpr Row kTile = {"", kTileMembers};

constexpr Member kAreaMembers[] = {
    member<&picture::Area::left>("left"),
    member<&picture::Area::bottom>("bottom"),
    member<&picture::Area::right>("right"),
    member<&picture::Area::top>("top"),
};
constexpr Row kArea = {"", kAreaMembers, "Metres."};

constexpr Member kHeightsMembers[] = {
    member<&picture::Heights::low>("low"),
    member<&picture::Heights::high>("high"),
};
constexpr Row kHeights = {"", kHeightsMembers, "Metres."};

constexpr Member kFinerMembers[] = {
    member<&picture::FinerLevels::level>("level", "finest level: -1 or -2"),
    member<&picture::FinerLevels::version>("version"),
    member<&picture::FinerLevels::area>("area", "area that changed"),
};
constexpr Row kFiner = {"", kFinerMembers, "The finer tiles that exist now."};

constexpr std::string_view kMapKinds[] = {"grid", "cloud"};

constexpr Member kLayerMembers[] = {
    member<&LayerView::layer, &picture::Layer::robot>("robot", "empty for the merged map"),
    member<&LayerView::layer, &picture::Layer::kind>("kind").one_of(kMapKinds),
    member<&LayerView::bounds>("bounds"),
    member<&LayerView::heights>("heights"),
    member<&LayerView::first>("first"),
    member<&LayerView::last>("last"),
    member<&LayerView::version>("version"),
    member<&LayerView::missed>("missed", "number of maps that the picture lacks"),
    member<&LayerView::left_out>("left_out", "cells or points of the last map beyond the picture"),
    member<&LayerView::finer>("finer", "null if no tiles are finer than the base"),
    member<&LayerView::tiles>("tiles"),
};
constexpr Row kLayer = {"Layer", kLayerMembers};

constexpr Member kColours[] = {
    member<&MapColours::free>("free"),
    member<&MapColours::occupied>("occupied"),
    member<&MapColours::heights>("heights", "evenly spaced, lowest first"),
};

constexpr Member kMap[] = {
    member<&MapView::version>("version"),
    member<&MapView::tile_side>("tile_side", "pixels"),
    member<&MapView::metres_per_pixel>("metres_per_pixel", "for each level, base first"),
    member<&MapView::finer_metres_per_pixel>("finer_metres_per_pixel", "for levels -1, -2"),
    member<&MapView::colours>("colours"),
    member<&MapView::spacing>("spacing", "seconds between two stored states"),
    member<&MapView::wiped>("wiped", "begin of the last run, if the box saw it begin"),
    member<&MapView::missed>("missed", "number of maps whose layer is one too many"),
    member<&MapView::layers>("layers"),
};

constexpr Member kCoveredRow[] = {
    member<&CoveredRow::robot>("robot", "empty for the merged map"),
    member<&CoveredRow::square_metres>("square_metres"),
};

constexpr Member kCovered[] = {
    member<&CoveredView::version>("version", "the map's version"),
    member<&CoveredView::square_metres>("square_metres",
                                        "area that several robots cover counts once; 0 without a grid"),
    member<&CoveredView::whole>("whole", "false if the picture lacks parts of grids: the area is larger"),
    member<&CoveredView::robots>("robots", "robots whose grids have known cells"),
};

}  // namespace

constexpr Row CoveredRow::kRow = codec::complete<CoveredRow>({"", kCoveredRow});
constexpr Row CoveredView::kRow = codec::complete<CoveredView>(
    {"Covered", kCovered, "The area that delivered grids show as known, in squares of 0.25 m."});
constexpr Row MapColours::kRow = codec::complete<MapColours>({"", kColours});
constexpr Row MapView::kRow =
    codec::complete<MapView>({"Map", kMap, "The layers of the picture of the maps."});

MapView map_view(const picture::Mosaic& map, std::uint64_t since) {
  const auto grid = picture::grid_palette();
  const auto heights = picture::height_ramp();
  return {
      .version = map.version(),
      .metres_per_pixel = {picture::kMetresPerPixel.begin(), picture::kMetresPerPixel.end()},
      .finer_metres_per_pixel = {picture::kFineMetresPerPixel.begin(), picture::kFineMetresPerPixel.end()},
      .colours = {.free = grid[1],
                  .occupied = grid[picture::kMostOccupiedIndex],
                  .heights = {heights.begin(), heights.end()}},
      .spacing = map.spacing(),
      .wiped = map.wipe_time(),
      .missed = map.missed_maps(),
      .layers = map.layers(since)};
}

CoveredView covered_view(const picture::Coverage& covered) {
  CoveredView view{.version = covered.version,
                   .square_metres = picture::square_metres(covered.all),
                   .whole = covered.is_whole,
                   .robots = {}};
  for (const auto& [robot, pixels] : covered.of)
    view.robots.push_back({robot, picture::square_metres(pixels)});
  return view;
}

}  // namespace adit::api
