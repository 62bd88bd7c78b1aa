#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/client.hpp"
#include "simulation/messages.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// A robot: posts where it is, grids that cover earlier ones or do not, clouds by themselves or several in a
/// row, of what is new or of all since its map began, and markers that it changes and deletes. Its serials
/// rise.
class Robot {
 public:
  static constexpr std::int64_t kSerials = 4096;  // of one robot, from `number` times as many on

  Robot(World& world, int number);
  /// Until then, on the run's clock.
  void post_until(double end);

 private:
  void post();
  Item item(std::string who, Says says = {});
  Item grid();
  Item window();
  Item cloud();
  Posting clouds();
  Posting markers();
  Posting next();

  World& world_;
  const int number_;
  Random random_;
  const std::string name_;
  const std::string finds_ns_;  // "": its markers have no namespace; several robots may share that
  Client client_;
  const Style style_;
  const double clock_;  // seconds by which its clock is off
  const double jump_;   // and by which it is set once
  const double jumps_at_;
  const bool stamps_;
  const double every_;  // seconds between two messages, about
  const double wipes_;  // how likely a change of markers deletes all
  int writings_;        // still to come: markers with texts so long that they fill the journal
  double end_ = 0;
  std::int64_t serial_;
  Extent extent_;           // of its own map, which grows
  const bool whole_;        // each of its clouds has all points since its map began
  std::vector<Item> said_;  // then its clouds since, the newest first
  std::uint64_t row_ = 0;   // maps still to come in this row
  const bool rolls_;        // its grids are a window that moves with it, several in a row
  bool row_of_grids_ = false;
  Extent window_{.width = 12, .height = 12};
};

}  // namespace adit::simulation
