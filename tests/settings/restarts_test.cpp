// The parts of a running gateway that each setting restarts.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <string>

#include "settings/keys.hpp"
#include "settings/sample.hpp"
#include "settings/settings.hpp"

namespace adit::settings {
namespace {

using namespace std::chrono_literals;

constexpr Restarts kNothing{}, kListeners{.listeners = true}, kScoring{.scoring = true},
    kMapping{.mapping = true}, kBoth{.scoring = true, .mapping = true}, kPanel{.panel = true};

struct RestartsCase {
  std::string path;  // as in keys()
  std::function<void(Settings&)> change;
  Restarts restarts;
};

const RestartsCase kRestartsCases[] = {
    {"command_post.scoring.address", [](Settings& s) { s.command_post.scoring.address = "10.9"; }, kScoring},
    {"command_post.scoring.port", [](Settings& s) { s.command_post.scoring.port = 9; }, kScoring},
    {"command_post.mapping.address", [](Settings& s) { s.command_post.mapping.address = "10.9"; }, kMapping},
    {"command_post.mapping.port", [](Settings& s) { s.command_post.mapping.port = 9; }, kMapping},
    {"command_post.interface", [](Settings& s) { s.command_post.interface = "darpa1"; }, kBoth},
    {"command_post.budget_mbit", [](Settings& s) { s.command_post.budget_mbit = 9; }, kMapping},
    {"command_post.rates.reports_hz", [](Settings& s) { s.command_post.rates.reports_hz = 9; }, kNothing},
    {"command_post.rates.status_hz", [](Settings& s) { s.command_post.rates.status_hz = 9; }, kNothing},
    {"command_post.rates.map_hz", [](Settings& s) { s.command_post.rates.map_hz = 9; }, kNothing},
    {"command_post.rates.state_hz", [](Settings& s) { s.command_post.rates.state_hz = 9; }, kNothing},
    {"command_post.rates.markers_hz", [](Settings& s) { s.command_post.rates.markers_hz = 9; }, kNothing},
    {"command_post.timeouts.connect_ms", [](Settings& s) { s.command_post.timeouts.connect = 9ms; }, kBoth},
    {"command_post.timeouts.scoring_answer_ms",
     [](Settings& s) { s.command_post.timeouts.scoring_answer = 9ms; }, kScoring},
    {"command_post.timeouts.mapping_answer_ms",
     [](Settings& s) { s.command_post.timeouts.mapping_answer = 9ms; }, kMapping},
    {"command_post.arrange_clouds", [](Settings& s) { s.command_post.arrange_clouds = false; }, kNothing},
    {"command_post.course", [](Settings& s) { s.command_post.course = "B"; }, kNothing},
    {"courses[].name", [](Settings& s) { s.courses.front().name = "B"; }, kNothing},
    {"courses[].scoring.address", [](Settings& s) { s.courses.front().scoring.address = "10.9"; }, kNothing},
    {"courses[].scoring.port", [](Settings& s) { s.courses.front().scoring.port = 9; }, kNothing},
    {"courses[].mapping.address", [](Settings& s) { s.courses.front().mapping.address = "10.9"; }, kNothing},
    {"courses[].mapping.port", [](Settings& s) { s.courses.front().mapping.port = 9; }, kNothing},
    {"team.listen[].address", [](Settings& s) { s.team.listen.front().address = "10.9"; }, kListeners},
    {"team.listen[].port", [](Settings& s) { s.team.listen.front().port = 9; }, kListeners},
    {"team.interface", [](Settings& s) { s.team.interface = "team1"; }, kListeners},
    {"team.require_token", [](Settings& s) { s.team.require_token = !s.team.require_token; }, kNothing},
    {"team.origins", [](Settings& s) { s.team.origins = "http://10.0.0.20:3000"; }, kNothing},
    {"team.connections", [](Settings& s) { s.team.connections = 9; }, kListeners},
    {"team.connections_per_address", [](Settings& s) { s.team.connections_per_address = 9; }, kListeners},
    {"robots[].name", [](Settings& s) { s.robots.front().name = "r9"; }, kNothing},
    {"robots[].alias", [](Settings& s) { s.robots.front().alias = "other"; }, kNothing},
    {"robots[].clouds", [](Settings& s) { s.robots.front().clouds = queues::Clouds::Whole; }, kNothing},
    {"robots[].precision", [](Settings& s) { s.robots.front().precision = queues::Precision::Auto; },
     kNothing},
    {"robots[].colour", [](Settings& s) { s.robots.front().colour = 2; }, kNothing},
    {"network.confirm_within_ms", [](Settings& s) { s.network.confirm_within = 9s; }, kNothing},
    {"network.allow_overlap", [](Settings& s) { s.network.allow_overlap = true; }, kNothing},
    {"page.https_only", [](Settings& s) { s.page.https_only = true; }, kNothing},
    {"clock.ntp_server", [](Settings& s) { s.clock.ntp_server = "10.0.0.5"; }, kNothing},
    {"clock.serve_ntp", [](Settings& s) { s.clock.serve_ntp = true; }, kNothing},
    {"reports.answer_within_ms", [](Settings& s) { s.reports.answer_within = 9s; }, kNothing},
    {"reports.doubt_for_ms", [](Settings& s) { s.reports.doubt_for = 9s; }, kNothing},
    {"reports.doubt_asks", [](Settings& s) { s.reports.doubt_asks = 9; }, kNothing},
    {"reports.review", [](Settings& s) { s.reports.review = dispatch::Review::All; }, kNothing},
    {"reports.near_metres", [](Settings& s) { s.reports.near_metres = 9; }, kNothing},
    {"reports.undo_s", [](Settings& s) { s.reports.undo = 9s; }, kNothing},
    {"queues.map_bytes", [](Settings& s) { s.queues.map_bytes = 9; }, kNothing},
    {"queues.merge_bytes", [](Settings& s) { s.queues.merge_bytes = 9; }, kNothing},
    {"queues.marker_bytes", [](Settings& s) { s.queues.marker_bytes = 9; }, kNothing},
    {"queues.markers_per_message", [](Settings& s) { s.queues.markers_per_message = 9; }, kNothing},
    {"queues.marker_bytes_per_message", [](Settings& s) { s.queues.marker_bytes_per_message = 9; }, kNothing},
    {"runs.length_seconds", [](Settings& s) { s.runs.length_seconds = 99; }, kNothing},
    {"runs.run_bytes", [](Settings& s) { s.runs.run_bytes = 9; }, kNothing},
    {"runs.all_bytes", [](Settings& s) { s.runs.all_bytes = 9; }, kNothing},
    {"alarms.silent_for_ms", [](Settings& s) { s.alarms.silent_for = 9s; }, kNothing},
    {"alarms.silent_times", [](Settings& s) { s.alarms.silent_times = 9; }, kNothing},
    {"rules.rewrite_frame_id", [](Settings& s) { s.rules.rewrite_frame_id = !s.rules.rewrite_frame_id; },
     kNothing},
    {"rules.forward_unknown_types",
     [](Settings& s) { s.rules.forward_unknown_types = !s.rules.forward_unknown_types; }, kNothing},
    {"rules.map_bytes", [](Settings& s) { s.rules.map_bytes = 9; }, kNothing},
    {"panel.chip", [](Settings& s) { s.panel.chip = "x"; }, kPanel},
    {"panel.health", [](Settings& s) { s.panel.health = "x"; }, kPanel},
    {"panel.scoring", [](Settings& s) { s.panel.scoring = "x"; }, kPanel},
    {"panel.mapping", [](Settings& s) { s.panel.mapping = "x"; }, kPanel},
    {"panel.attention", [](Settings& s) { s.panel.attention = "x"; }, kPanel},
    {"panel.active_low", [](Settings& s) { s.panel.active_low = !s.panel.active_low; }, kPanel},
    {"panel.button", [](Settings& s) { s.panel.button = "x"; }, kPanel},
    {"panel.button_active_low", [](Settings& s) { s.panel.button_active_low = !s.panel.button_active_low; },
     kPanel},
};

Settings running() {
  Settings settings = with_an_item_of_each();
  settings.robots.front().name = "r1";
  settings.courses.front().name = "A";
  return settings;
}

TEST(Restarts, AreExactlyTheChangedParts) {
  for (const RestartsCase& each : kRestartsCases) {
    Settings next = running();
    each.change(next);
    EXPECT_EQ(restarts_by(running(), next), each.restarts) << each.path;
  }
}

TEST(Restarts, CoverEachSetting) {
  for (const Key& key : keys()) {
    if (key.path == "version") continue;
    EXPECT_TRUE(std::ranges::find(kRestartsCases, key.path, &RestartsCase::path) != std::end(kRestartsCases))
        << key.path;
  }
}

TEST(Restarts, AreEmptyWithoutChanges) {
  EXPECT_EQ(restarts_by(running(), running()), kNothing);
}

TEST(Restarts, JoinThoseOfSeveralSettings) {
  Settings next = running();
  next.team.listen.emplace_back("10.9", 9);
  next.command_post.scoring.port = 9;
  next.reports.near_metres = 9;
  EXPECT_EQ(restarts_by(running(), next), (Restarts{.listeners = true, .scoring = true}));
}

TEST(Restarts, IncludeTheEndpointsOfTheCourseInUse) {
  Settings now = running(), next = running();
  now.command_post.scoring = {"10.1", 1};
  next.command_post = now.command_post;
  next.courses.front().scoring = {"10.9", 9};
  next.courses.front().mapping = now.command_post.mapping;
  next.command_post.course = "A";
  EXPECT_EQ(restarts_by(effective_settings(now), effective_settings(next)), kScoring);
}

}  // namespace
}  // namespace adit::settings
