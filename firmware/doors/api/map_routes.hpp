#pragma once

#include <expected>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "api/finer_map.hpp"
#include "api/route.hpp"
#include "api/scene.hpp"
#include "api/source.hpp"
#include "intake/server.hpp"
#include "picture/mosaic.hpp"
#include "picture/palette.hpp"

namespace adit::api {

/// Leaves out poses that lie on a straight way, so that interpolation in time between the others gives each
/// of them back (has_moved() tells no difference). A way is at most 10 s long. First and last pose stay.
Tracks thinned(std::vector<Track> tracks);

/// A request for a tile: place, colours, and the client's cached state.
struct TileAsked {
  picture::Layer layer;
  picture::TileIndex at;
  std::optional<double> stamp, low, high;
  std::optional<picture::Colour> from, to;  // for free or lowest, and for occupied or highest
  std::string has;                          // If-None-Match
};

/// `parts`: kind, robot, level, x and y from the path. An error is the answer.
std::expected<TileAsked, intake::Answer> tile_asked(const intake::RequestHead& head,
                                                    std::span<const std::string> parts);

/// The PNG, or the reason for its absence.
intake::Answer tile_of(const picture::Mosaic& map, const TileAsked& asked);

/// The same for a drawn tile of a finer level. Null: 204, because the client cannot know which tiles exist.
intake::Answer finer_tile(const picture::Tile& tile, const TileAsked& asked);

/// The number in ?since=, or 0 without it. An error is the answer.
std::expected<std::uint64_t, intake::Answer> version_asked(const intake::RequestHead& head);

/// The map, the markers and the robots' tracks: README.md.
class MapRoutes {
 public:
  /// All must outlive this object.
  MapRoutes(const Source& source, FinerMap& finer, CoveredMap& covered)
      : source_(source), finer_(finer), covered_(covered) {}

  intake::Answer layers(const intake::RequestHead& head) const;
  void tile(const Call& call) const;
  void covered(const Call& call) const;
  intake::Answer markers(const intake::RequestHead& head) const;
  intake::Answer tracks(const intake::RequestHead& head) const;

 private:
  const Source& source_;
  FinerMap& finer_;
  CoveredMap& covered_;
};

}  // namespace adit::api
