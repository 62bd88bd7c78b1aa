#pragma once

#include <expected>
#include <optional>
#include <span>
#include <string>

#include "intake/server.hpp"
#include "picture/mosaic.hpp"
#include "picture/palette.hpp"

namespace adit::api {

/// Which tile is asked for, how it is to be coloured, and what the asker has already.
struct TileAsked {
  picture::Layer layer;
  picture::TileAt at;
  std::optional<double> stamp, low, high;
  std::optional<picture::Colour> from, to;  // of what is free or lowest, and of what is occupied or highest
  std::string has;                          // If-None-Match
};

/// `parts`: kind, robot, level, x and y, of the path. An error is the answer.
std::expected<TileAsked, intake::Answer> tile_asked(const intake::RequestHead& head,
                                                    std::span<const std::string> parts);

/// The PNG, or why there is none.
intake::Answer tile_of(const picture::Mosaic& map, const TileAsked& asked);

/// The same of a finer level, which was drawn. Null: 204, for whoever asks cannot know where there is one.
intake::Answer finer_tile(const picture::Tile& tile, const TileAsked& asked);

/// Of ?since=, 0 without it. An error is the answer.
std::expected<std::uint64_t, intake::Answer> version_asked(const intake::RequestHead& head);

}  // namespace adit::api
