// All of them, and what a power cut may cost.
#include "simulation/checks.hpp"

#include <algorithm>

#include "simulation/messages.hpp"

namespace adit::simulation {
namespace {

/// What was accepted before the last power cut, but for reports, may have been lost, or not: what waited was
/// in memory. It is as if its client had heard nothing.
std::vector<Event> with_losses(const std::vector<Event>& events) {
  int lives = 0;  // that ended by the last cut, and before
  for (const Event& event : events) {
    if (event.kind == Kind::PowerCut) lives = event.life;
  }
  std::vector<Event> told = events;
  for (Event& event : told) {
    if (event.kind != Kind::Answered || event.what == kReports || event.life > lives) continue;
    event.kind = Kind::Gone;
    event.status = 0;
  }
  return told;
}

}  // namespace

double clock_behind(const Evidence& evidence) {
  constexpr double kMost = 60;  // its own stamps, which are kept, bring it on
  const bool is_set_back =
      std::ranges::any_of(evidence.events, [](const Event& event) { return event.kind == Kind::PowerCut; });
  return is_set_back ? kMost : 0;
}

Broken all_checks(const Evidence& evidence) {
  Broken broken;
  for (const auto check :
       {starts,  settings_kept, once,        not_lost, paced,  learned, stamps, kept,   answered, not_cut,
        refused, clean,         status_true, live,     honest, lights,  alive,  obeyed, bounded,  has_room})
    check(evidence, broken);
  const std::vector<Event> told = with_losses(evidence.events);
  const Evidence with_them{told, evidence.reports, evidence.readings, evidence.most_map_bytes};
  for (const auto check : {cloud_arrived, markers_arrived, pose_arrived, grid_arrived})
    check(with_them, broken);
  return broken;
}

}  // namespace adit::simulation
