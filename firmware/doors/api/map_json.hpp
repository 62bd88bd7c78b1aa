#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "codec/row.hpp"
#include "picture/coverage.hpp"
#include "picture/mosaic.hpp"
#include "picture/palette.hpp"

namespace adit::api {

struct MapColours {
  picture::Colour free, occupied;
  std::vector<picture::Colour> heights;

  static const codec::Row kRow;
};

/// /adit/map: geometry and colours of tiles, and every layer with its changed tiles.
struct MapView {
  std::uint64_t version = 0;
  int tile_side = picture::kSide;
  std::vector<double> metres_per_pixel, finer_metres_per_pixel;
  MapColours colours;
  double spacing = 0;
  std::optional<double> wiped;
  std::size_t missed = 0;
  std::vector<picture::LayerView> layers;

  static const codec::Row kRow;
};

struct CoveredRow {
  std::string robot;
  double square_metres = 0;

  static const codec::Row kRow;
};

/// /adit/covered
struct CoveredView {
  std::uint64_t version = 0;
  double square_metres = 0;
  bool whole = true;
  std::vector<CoveredRow> robots;

  static const codec::Row kRow;
};

CoveredView covered_view(const picture::Coverage& covered);

/// Includes only tiles that changed after version `since`.
MapView map_view(const picture::Mosaic& map, std::uint64_t since);

}  // namespace adit::api
