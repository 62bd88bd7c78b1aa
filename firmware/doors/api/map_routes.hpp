#pragma once

#include <expected>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "api/finer_map.hpp"
#include "api/kept_runs.hpp"
#include "api/route.hpp"
#include "api/scene.hpp"
#include "api/source.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"
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

/// Stored data of the present and earlier runs: README.md. A run is read once and held for kHeld after its
/// last use.
class KeptRunsRoutes {
 public:
  static constexpr std::chrono::seconds kHeld{60};
  static constexpr std::size_t kMostWaiting = 64;  // requests queued while a run is read

  /// All must outlive this object.
  KeptRunsRoutes(loop::Loop& loop, KeptRuns& runs, const Source& source);

  /// The plots of the present run.
  intake::Answer history(const intake::RequestHead& head) const;

  intake::Answer list() const;
  intake::Answer one(const Call& call) const;
  void layers(const Call& call);
  void tile(const Call& call);
  void tracks(const Call& call);
  void plots(const Call& call);
  /// The report for printing, as HTML.
  void report(const Call& call);
  void remove(const Call& call);

 private:
  using Answering = std::function<intake::Answer(const KeptRun& run)>;
  struct Waiting {
    std::shared_ptr<intake::Responder> responder;
    Answering answer;
  };
  struct Gathering;
  void with_run(const Call& call, Answering answer);
  void came(const std::string& key, const icd::Checked<std::shared_ptr<const KeptRun>>& run);
  void gather(const std::shared_ptr<Gathering>& gathering);
  const RunRow* row_of(const RunList& list, const std::string& key) const;

  loop::Loop& loop_;
  KeptRuns& runs_;
  const Source& source_;
  loop::Source forget_;
  std::shared_ptr<const KeptRun> held_;
  std::map<std::string, std::vector<Waiting>> waiting_;
};

}  // namespace adit::api
