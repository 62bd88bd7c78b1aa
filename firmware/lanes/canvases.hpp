#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "lanes/canvas.hpp"
#include "lanes/extent.hpp"
#include "lanes/waiting_map.hpp"

namespace adit::lanes {

/// What was last sent of each robot's grids, so that a gap between grids can be sent with them: its cells
/// have the newest value that was packed, or were never sent in this run. Where that is not known, for the
/// memory's bound, for a try that failed, or from before a restart or another Command Post, nothing is
/// filled.
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
  using Posted = std::map<std::string, Extent>;
  static constexpr const char* kAnyName = "*";

  /// Maps go to this Command Post from now on.
  void lead_to(std::string command_post);
  /// What the lives before may have sent.
  void carry_on(Posted before) { before_ = posted_ = std::move(before); }
  /// That grid comes: what must be known to a life to come before the grid is taken; nothing if that is
  /// known.
  std::optional<std::pair<std::string, Extent>> grows(const icd::MapUpdate& grid) const;
  void grown(const std::pair<std::string, Extent>& posted) {
    posted_.insert_or_assign(posted.first, posted.second);
  }
  /// Another run is on, with a map of its own, which is not known.
  void change_run() { canvases_.clear(); }
  /// A run begins at this Command Post with an empty map, but for the grids among `under_way`, which may
  /// arrive in it. At others, what was sent stays.
  void begin_run(std::span<const icd::MapUpdate* const> under_way);

  /// Of grids of that name; null where nothing is known.
  const Canvas* find(const std::optional<icd::RobotName>& name) const;

  /// That grid is packed next: it gets what lies under it, where that is to be drawn. If this throws, less is
  /// known, and `next` is as it was.
  void sends(WaitingMap& next);
  /// As it was drawn over that.
  void lay(const std::optional<icd::RobotName>& name, const Ground& drawn);

 private:
  std::optional<Extent> sent(const std::optional<icd::RobotName>& name) const;
  std::string here(const std::optional<icd::RobotName>& name) const;
  void note(const std::optional<icd::RobotName>& name, const Extent& extent);
  void forget_oldest();

  std::size_t most_tiles_;
  std::string command_post_;
  std::map<std::optional<icd::RobotName>, Canvas> canvases_;
  Posted before_, posted_;              // by the end of the life before, and by now
  std::set<std::string> began_;         // Command Posts that have nothing of the life before
  std::map<std::string, Extent> sent_;  // in this life, by name@Command Post
  std::uint64_t numbers_ = 0, laid_ = 0;
};

}  // namespace adit::lanes
