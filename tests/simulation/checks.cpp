// Runs all checks, and decides what a power cut may lose.
#include "simulation/checks.hpp"

#include <algorithm>

#include "simulation/messages.hpp"

namespace adit::simulation {
namespace {

/// Everything that was accepted before the last power cut, except reports, was in memory and may be lost or
/// not. So these requests count as if their clients had heard no answer.
std::vector<Event> with_losses(const std::vector<Event>& events) {
  int last_process = 0;  // processes up to the last power cut
  for (const Event& event : events) {
    if (event.kind == Kind::PowerCut) last_process = event.process;
  }
  std::vector<Event> told = events;
  for (Event& event : told) {
    if (event.kind != Kind::Answered || event.what == kReports || event.process > last_process) continue;
    event.kind = Kind::Gone;
    event.status = 0;
  }
  return told;
}

}  // namespace

Window window_of(const Evidence& evidence, double first, double last) {
  constexpr double kForever = 1e12;
  /// At most seconds by which the stored time is behind at a power cut if the disk was faulty before it, and
  /// by which the next gateway's clock for stamps is ahead.
  constexpr double kOff = 200;
  double behind = 0;  // how far the box's clock is behind after a start
  DiskFaultsSeen disk;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::PowerCut || disk.forgets_at(event)) {
      first -= kOff;
      last += kOff;
    }
    disk.add(event);
    const bool by_a_start = event.stamp == -event.at;
    if (event.kind == Kind::ClockSet && !by_a_start) return {0, kForever};
    if (event.kind == Kind::ClockSet) behind = std::max(behind, event.at);
  }
  return {first, last + behind};
}

Broken all_checks(const Evidence& evidence) {
  Broken broken;
  for (const auto check : {starts,
                           settings_kept,
                           once,
                           addressed,
                           not_lost,
                           paced,
                           reports_go_first,
                           status_keeps_away,
                           status_has_its_turn,
                           learned,
                           others_go_on,
                           stamps,
                           kept,
                           answered,
                           not_cut,
                           refused,
                           clean,
                           status_true,
                           live,
                           decided,
                           honest,
                           lights,
                           alive,
                           obeyed,
                           bounded,
                           older_copy,
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
