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

Window window_of(const Evidence& evidence, double first, double last) {
  constexpr double kForever = 1e12;
  /// Of each cut: the time that was kept last is that old where the disk was at fault, and then no power.
  constexpr double kBehind = 200;
  double behind = 0;  // by which the box's clock is, after a start
  DiskFaultsSeen disk;
  for (const Event& event : evidence.events) {
    // The next gateway's clock for stamps is ahead, and times of the one before seem as much older.
    if (event.kind == Kind::PowerCut || disk.forgets_at(event)) last += kBehind;
    disk.add(event);
    const bool by_a_start = event.stamp == -event.at;
    if (event.kind == Kind::ClockSet && !by_a_start) return {0, kForever};
    if (event.kind == Kind::ClockSet) behind = std::max(behind, event.at);
  }
  return {first, last + behind};
}

Broken all_checks(const Evidence& evidence) {
  Broken broken;
  for (const auto check :
       {starts,      settings_kept, once,   not_lost, paced,   reports_go_first, status_keeps_away,
        learned,     stamps,        kept,   answered, not_cut, refused,          clean,
        status_true, live,          honest, lights,   alive,   obeyed,           bounded,
        has_room})
    check(evidence, broken);
  const std::vector<Event> told = with_losses(evidence.events);
  const Evidence with_them{told, evidence.reports, evidence.readings, evidence.most_map_bytes,
                           evidence.missing};
  for (const auto check : {cloud_arrived, markers_arrived, pose_arrived, grid_arrived})
    check(with_them, broken);
  return broken;
}

}  // namespace adit::simulation
