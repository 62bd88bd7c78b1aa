#pragma once

#include <string>

#include "settings/settings.hpp"
#include "simulation/box.hpp"
#include "simulation/client.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

inline constexpr const char* kSettings = "/adit/settings";
/// Event::what of Kind::Saved: `review` is "all", or another value. Event::serial: reports.undo_s.
inline constexpr const char *kReviewAll = "review all", *kReviewElse = "settings";

/// In a third of the runs, saves settings of several sections by the page's API, up to three times. The
/// gateway applies them in place.
class Operator {
 public:
  /// Is logged in from the beginning. `world` and `box` must outlive it.
  Operator(World& world, const Box& box, double until);

 private:
  void change(settings::Settings& next);
  void save();

  World& world_;
  const Box& box_;
  Random random_;
  Client client_;
  std::string id_, csrf_;
};

}  // namespace adit::simulation
