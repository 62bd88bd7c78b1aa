#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/client.hpp"
#include "simulation/messages.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// A robot. It posts its pose, grids that cover earlier ones or not, on one lattice or on many, clouds singly
/// or several in a row, with new points or all points since its map began, and markers that it changes and
/// deletes. Its serials ascend. Some robots post a fourth of their messages on a slow connection, and go on
/// with the others meanwhile. Some post a backlog of old poses beside their new ones, faster than time or
/// not. Clocks may jump. The origins of one robot in four are off by up to 110 mm each time (cells have
/// 0.5 m), and those of one in five move by 90 mm each time. Clouds may be big-endian, padded, or have points
/// that are not numbers; quaternions may have length 2. Half of the markers of three robots in ten have a
/// lifetime of 0.1 to 20 s.
class Robot {
 public:
  static constexpr std::int64_t kSerials = 4096;  // serials per robot, from `number` times this

  Robot(World& world, int number);
  /// Posts until `end`, on the run's clock.
  void post_until(double end);

 private:
  void post();
  void post_later();
  void fill_backlog();
  void post_backlog();
  Item item(std::string who, Says says = {});
  Item grid();
  Item window();
  Extent moved(Extent extent);
  Item cloud();
  Posting clouds();
  Posting markers();
  Posting next();

  World& world_;
  const int number_;
  Random random_;
  const std::string name_;
  const std::string finds_ns_;  // "": its markers have no namespace, which several robots may share
  Client client_;
  Random slowly_;
  const bool overtakes_;  // itself, on the other connection
  Client slow_client_;
  const Style style_;
  const double clock_;  // seconds by which its clock is off
  const double jump_;   // seconds by which its clock is set, once
  const double jumps_at_;
  const bool stamps_;
  Random logs_;
  const bool has_backlog_;
  Client log_client_;
  std::vector<double> backlog_ = {};  // times of poses, the next one last
  const double every_;                // approximate seconds between two messages
  const double wipes_;                // probability that a change of markers deletes all
  int writings_;                      // remaining markers with texts so long that they fill the journal
  double end_ = 0;
  std::int64_t serial_;
  Extent extent_;                    // of its growing map
  const bool whole_;                 // each cloud has all points since its map began
  std::vector<Item> recent_clouds_;  // the clouds since then, the newest first
  std::uint64_t row_ = 0;            // maps left in this row
  const bool rolls_;                 // its grids are a window that moves with it, several in a row
  bool row_of_grids_ = false;
  Extent window_{.width = 12, .height = 12};
  Random drift_;
  const bool jitters_;  // each of its grids has another origin, off by less than a fourth of a cell
  const bool creeps_;   // its grids move by less than a fourth of a cell each time
  int crept_ = 0;       // steps
  Random fade_;
  const bool fades_;  // half of its markers have a lifetime
  int large_;         // remaining clouds with noise
  int large_grids_;   // remaining
  const Extent large_grid_{.x = -40'000, .y = -40'000, .width = 340, .height = 340};
  const std::size_t noise_;
};

}  // namespace adit::simulation
