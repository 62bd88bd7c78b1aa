#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "queues/canvas.hpp"
#include "queues/extent.hpp"
#include "queues/queued_map.hpp"

namespace adit::queues {

/// The cells that were last sent of each robot's grids. MapQueue stitches grids into one rectangle and fills
/// the gaps with these cells: each has the newest value that was packed, or was never sent to the present map
/// of the Command Post. A gap is not filled if its cells are unknown. Cells become unknown because of the
/// memory's limit, a failed try, a restart, another Command Post, or a run that may still be the previous
/// one.
///
/// A map that failed is retried before newer maps and is drawn again, so that a filled gap is never older
/// than the cells that arrived.
class Canvases {
 public:
  static constexpr std::size_t kMostTiles = 4096;       // with known cells: 16 MiB
  static constexpr std::size_t kMostForgotten = 65536;  // tiles of all canvases
  static constexpr std::size_t kMostNames = 256;        // the grids of further names are unknown

  explicit Canvases(std::size_t most_tiles = kMostTiles) : most_tiles_(most_tiles) {}

  /// By the grids' name: the extent in which grids were posted, or sent. kAnyName stands for all names.
  using Posted = std::map<std::string, Extent>;
  static constexpr const char* kAnyName = "*";

  /// Sets the Command Post that maps are sent to from now on.
  void lead_to(std::string command_post);
  /// Sets what earlier processes may have sent.
  void carry_on(Posted before);
  /// The extent to be recorded before `grid` is accepted, so that a later process knows it; nothing if it is
  /// recorded already.
  std::optional<std::pair<std::string, Extent>> grows(const icd::MapUpdate& grid) const;
  void grown(const std::pair<std::string, Extent>& posted) {
    posted_.insert_or_assign(posted.first, posted.second);
  }
  /// The Command Post has answered with a status of the present run. It was asked after all grids that were
  /// sent before the previous status had arrived, except those that are still in flight (`under_way`).
  void heard(std::span<const icd::MapUpdate* const> under_way);
  /// The run may have changed: the Command Post's cells are unknown.
  void change_run() { canvases_.clear(); }
  /// A run has begun with an empty map after the last status of the previous run. Grids that were sent since
  /// the status before that one may have arrived in the new run. What other Command Posts have stays.
  void begin_run();
  /// An earlier run goes on: its map may have any cell that was posted.
  void take_up_run();

  /// The canvas of the grids of that name, or null if there is none.
  const Canvas* find(const std::optional<icd::RobotName>& name) const;

  /// Call before `next` is packed: sets its `ground` if the grid is to be drawn. If this throws, fewer cells
  /// are known and `next` is unchanged.
  void sends(QueuedMap& next);
  /// Sets the cells as they were drawn over that ground.
  void lay(const std::optional<icd::RobotName>& name, const Ground& drawn);

 private:
  /// The grids that were sent to one Command Post.
  struct Sent {
    Posted all;           // what its present map may have
    Posted newer, older;  // sent since the last status of the present run; between that and the one before
  };
  Sent& here();
  void forget_oldest();

  std::size_t most_tiles_;
  std::string command_post_;
  std::map<std::optional<icd::RobotName>, Canvas> canvases_;
  Posted before_, posted_;            // until this process start, and until now
  std::map<std::string, Sent> sent_;  // by Command Post
  std::uint64_t numbers_ = 0, laid_ = 0;
};

}  // namespace adit::queues
