// The disk's copy of the run.
#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "api/verdicts.hpp"
#include "forward/flow.hpp"

namespace adit::forward {
namespace {

archive::Sample sample_of(const Flow& flow, double now) {
  std::map<std::string, double> ages;
  for (const auto& [traffic, row] : flow.counts().rows()) {
    const auto age = api::age_of(row, now);
    if (!is_map(traffic.kind) || !age) continue;
    const auto [its, is_new] = ages.emplace(traffic.robot, *age);
    its->second = std::min(its->second, *age);
  }
  const Channel& mapping = flow.maps().channel().last().heard() > flow.telemetry().channel().last().heard()
                               ? flow.maps().channel()
                               : flow.telemetry().channel();
  return {.at = now,
          .sent_mbit = flow.sent_mbit(),
          .queued_bytes = flow.maps().queued_bytes(),
          .scoring_ms = flow.scoring().channel().last().answer_ms(),
          .mapping_ms = mapping.last().answer_ms(),
          .throttled = flow.scoring().channel().last().throttled() +
                       flow.maps().channel().last().throttled() +
                       flow.telemetry().channel().last().throttled(),
          .map_ages = {ages.begin(), ages.end()}};
}

api::RunRow facts_of(const Flow& flow, const std::string& course) {
  const dispatch::Run& run = flow.reports().run();
  std::set<std::string> robots;
  for (const api::RobotRow& robot : flow.delivered().robots()) robots.insert(robot.name);
  for (const auto& [traffic, row] : flow.counts().rows()) robots.insert(traffic.robot);
  robots.erase("");
  api::RunRow facts{.run = run.number,
                    .id = run.id,
                    .course = course,
                    .post = run.post,
                    .began = run.began,
                    .robots = {robots.begin(), robots.end()}};
  if (run.last) {
    facts.score = run.last->score;
    facts.remaining_reports = run.last->remaining_reports;
    facts.team = run.last->current_team;
  }
  return facts;
}

}  // namespace

/// Restores the present run, then records it.
void Flow::keep_the_run() {
  const dispatch::Run& run = reports().run();
  picture_.hold();
  archive_.begin({.run = run.number, .began = run.began, .post = run.post},
                 [this](picture::Mosaic picture, std::vector<api::Track> tracks) -> const picture::Mosaic& {
                   delivered_.go_on_from(std::move(tracks));
                   picture_.go_on_from(std::move(picture));
                   return picture_.mosaic();
                 });
}

archive::Seen Flow::seen() const {
  return {.now = loop_.wall_now(),
          .stamp = loop_.stamp_now(),
          .picture = picture_.mosaic(),
          .tracks = [this](api::Time since) { return delivered_.tracks().since(since); },
          .sample = [this] { return sample_of(*this, loop_.wall_now()); },
          .facts = [this] { return facts_of(*this, settings_.command_post.course); }};
}

}  // namespace adit::forward
