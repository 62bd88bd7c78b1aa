#pragma once

#include <string>

#include "settings/settings.hpp"
#include "simulation/box.hpp"
#include "simulation/client.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

inline constexpr const char* kSettings = "/adit/settings";
/// Event::what of Kind::Saved: with review as "all", or as anything else. Event::serial: reports.undo_s.
inline constexpr const char *kReviewAll = "review all", *kReviewElse = "settings";

/// Saves settings by the page's API, which the gateway takes over in place.
class Operator {
 public:
  /// Logged in from the beginning. Both outlive this.
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
