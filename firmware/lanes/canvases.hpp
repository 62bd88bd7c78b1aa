#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "lanes/canvas.hpp"
#include "lanes/extent.hpp"
#include "lanes/waiting_map.hpp"

namespace adit::lanes {

/// What was last sent of each robot's grids, so that a gap between grids can be sent with them: its cells
/// have the newest value that was packed, or were never sent to the map that the Command Post has now. Where
/// that is not known, for the memory's bound, for a try that failed, or from before a restart, another
/// Command Post or a run that the present one may be still, nothing is filled.
///
/// What was packed and came back goes before all newer ones, and is drawn again: what is sent in a gap is not
/// older than what arrived.
class Canvases {
 public:
  static constexpr std::size_t kMostTiles = 4096;       // with cells: 16 MiB
  static constexpr std::size_t kMostForgotten = 65536;  // tiles of all canvases
  static constexpr std::size_t kMostNames = 256;        // above it nothing is known of what others sent

  explicit Canvases(std::size_t most_tiles = kMostTiles) : most_tiles_(most_tiles) {}

  /// Where grids of a name were ever posted, so that no other place can have been sent; kAnyName for all.
  /// Also where they were sent.
  using Posted = std::map<std::string, Extent>;
  static constexpr const char* kAnyName = "*";

  /// Maps go to this Command Post from now on.
  void lead_to(std::string command_post);
  /// What the lives before may have sent.
  void carry_on(Posted before);
  /// That grid comes: what must be known to a life to come before the grid is taken; nothing if that is
  /// known.
  std::optional<std::pair<std::string, Extent>> grows(const icd::MapUpdate& grid) const;
  void grown(const std::pair<std::string, Extent>& posted) {
    posted_.insert_or_assign(posted.first, posted.second);
  }
  /// A status of the present run was heard. It may have been asked for before what was sent since the last
  /// one arrived, but not before what was sent until then, except for what is still `under_way`.
  void heard(std::span<const icd::MapUpdate* const> under_way);
  /// Another run is on, or the same still: what is in the Command Post's cells is not known.
  void change_run() { canvases_.clear(); }
  /// A run is on that began with an empty map after the last status of the one before it. What was sent since
  /// the status before that may have arrived in it. At other Command Posts what was sent stays.
  void begin_run();
  /// A run from before is on again: its map may have whatever was posted.
  void take_up_run();

  /// Of grids of that name; null where nothing is known.
  const Canvas* find(const std::optional<icd::RobotName>& name) const;

  /// That grid is packed next: it gets what lies under it, where that is to be drawn. If this throws, less is
  /// known, and `next` is as it was.
  void sends(WaitingMap& next);
  /// As it was drawn over that.
  void lay(const std::optional<icd::RobotName>& name, const Ground& drawn);

 private:
  /// To one Command Post.
  struct Sent {
    Posted all;           // that may be in its present map
    Posted newer, older;  // since the last status of the present run; between that and the one before
  };
  Sent& here();
  void forget_oldest();

  std::size_t most_tiles_;
  std::string command_post_;
  std::map<std::optional<icd::RobotName>, Canvas> canvases_;
  Posted before_, posted_;            // by the end of the life before, and by now
  std::map<std::string, Sent> sent_;  // by Command Post
  std::uint64_t numbers_ = 0, laid_ = 0;
};

}  // namespace adit::lanes
