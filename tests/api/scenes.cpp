#include "api/scenes.hpp"

#include <cmath>
#include <string>

#include "alarms/verdict.hpp"

namespace adit::api {
namespace {

RunView empty(Time now) {
  RunView view;
  view.now = now;
  view.version = "0.1.0";
  view.endpoints = {{.name = "scoring", .address = "10.100.1.200:8000"},
                    {.name = "mapping", .address = "10.100.1.201:8000"}};
  view.lights = {{"health", "on"}, {"scoring", "off"}, {"mapping", "off"}, {"attention", "off"}};
  view.budget_mbit = 100;
  view.near_metres = 5;
  return view;
}

facts::ActivityRow traffic(std::string kind, std::string robot, Time now, double since,
                           std::uint64_t forwarded, std::size_t bytes) {
  return {.kind = std::move(kind),
          .robot = std::move(robot),
          .accepted = forwarded * 3 + 2,
          .forwarded = forwarded,
          .replaced = forwarded * 2,
          .behind_since = since < 10 ? std::optional(now - since) : std::nullopt,
          .last_accepted = now - since - 0.2,
          .last_forwarded = now - since,
          .last_no_room = {},
          .age = {},
          .heard = {},
          .bytes_received = bytes * 4,
          .bytes_sent = bytes,
          .last_status = 200,
          .last_sentence = {},
          .clouds = {},
          .precision = {}};
}

facts::ReportRow report(std::int64_t number, std::string type, Time received, std::string state, int status,
                        std::optional<std::int64_t> change) {
  return {.number = number,
          .type = std::move(type),
          .position = icd::Point{12.25 * static_cast<double>(number), -4.5, 0.25},
          .sender = "10.0.0.5",
          .robot = "",
          .received = received,
          .changed = received + 0.2,
          .state = std::move(state),
          .status = status,
          .report_status = change ? "scored" : "",
          .score_change = change,
          .note = {}};
}

alarms::Alarm alarm(std::string id, alarms::Severity severity, Time since, std::string what, std::string why,
                    alarms::Action action) {
  const std::size_t colon = id.find(':');
  return {.id = id,
          .severity = severity,
          .side = severity == alarms::Severity::Wait ? alarms::Side::Network : alarms::Side::CommandPost,
          .subject = colon == std::string::npos ? "" : id.substr(colon + 1),
          .since = since,
          .what = std::move(what),
          .why = std::move(why),
          .action = std::move(action)};
}

RunView calm(Time now, double elapsed) {
  RunView view = empty(now);
  const double heard = std::floor(elapsed);
  const Time began = now - elapsed;
  view.run = icd::RunStatus{7, 754 + heard, 18, "Cerberus"};
  view.run_clock = {.seconds = 754 + elapsed, .age = elapsed - heard, .runs = true};
  view.endpoints[0].connected = view.endpoints[1].connected = true;
  view.endpoints[0].last_status = view.endpoints[1].last_status = 200;
  view.endpoints[0].answer_ms = 3.4, view.endpoints[0].answered = 1;
  view.endpoints[1].answer_ms = 41, view.endpoints[1].answered = 0;
  view.lights = {{"health", "on"}, {"scoring", "on"}, {"mapping", "on"}, {"attention", "off"}};
  view.sent_mbit = 8 + 6 * std::sin(elapsed / 3) + 2 * std::sin(elapsed * 1.7);
  view.queued_bytes = 1'480'000;
  view.activities = {
      traffic("grid", "", now, 3, 212, 18'400),          traffic("grid", "ANYmal1", now, 2, 240, 9'300),
      traffic("cloud", "ANYmal1", now, 5, 180, 412'000), traffic("grid", "ANYmal2", now, 7, 198, 11'900),
      traffic("cloud", "ANYmal2", now, 1, 175, 388'000), traffic("cloud", "Scout", now, 4, 121, 96'000),
      traffic("state", "ANYmal1", now, 0.4, 710, 230),   traffic("state", "ANYmal2", now, 0.4, 710, 230),
      traffic("state", "Scout", now, 0.4, 709, 230),     traffic("markers", "", now, 21, 12, 1'900)};
  view.activities[2].merged = 96;
  view.activities[2].clouds = "parts", view.activities[2].precision = "8mm";
  view.robots = {{"ANYmal1", {24, 6, 0.5}, 0.5, now - 0.5},
                 {"ANYmal2", {52, -14, 0.25}, -2, now - 0.5},
                 {"Scout", {71 + 4 * std::sin(elapsed / 5), 18, 3}, 1.6, now - 0.5}};
  view.reports = {report(7, "Survivor", began - 14, "answered", 201, 1),
                  report(6, "Gas", began - 95, "answered", 201, 0),
                  report(5, "Fire Extinguisher", began - 188, "answered", 201, 1),
                  report(4, "Backpack", began - 260, "answered", 201, 1),
                  report(3, "Drill", began - 415, "answered", 201, 1),
                  report(2, "Rope", began - 520, "answered", 201, 0),
                  report(1, "Cell Phone", began - 610, "answered", 201, 1)};
  view.refusals = {{began - 130, "/map/update", "10.0.0.7", 422,
                    "msg.info.width: expected 80 x 60 = 4800 bytes of data, got 4799"}};
  view.alarms_over = {{.id = "robot_silent:Scout",
                       .side = alarms::Side::Robot,
                       .was = "Scout was silent",
                       .since = began - 141,
                       .until = began - 100}};
  return view;
}

RunView trouble(Time now, double elapsed) {
  RunView view = calm(now, elapsed);
  const Time began = now - elapsed;
  view.endpoints[1] = {.name = "mapping",
                       .address = "10.100.1.201:8000",
                       .trouble = "connecting to 10.100.1.201:8000: Connection refused",
                       .throttled = 3};
  view.lights = {{"health", "on"}, {"scoring", "on"}, {"mapping", "slow"}, {"attention", "fast"}};
  view.sent_mbit = 0;
  view.queued_bytes = 214'000'000;
  for (const std::size_t stuck : {1u, 2u}) {
    facts::ActivityRow& row = view.activities[stuck];
    row.queued = 12;
    row.behind_since = began - 110;
    row.failed = 9;
    row.last_accepted = began - 110;
    row.last_forwarded = began - 130;
    row.last_status = 0;
    row.last_sentence = "connecting to 10.100.1.201:8000: Connection refused";
  }
  view.activities[2].behind_since = began - 125;
  view.activities[3].queued = 247;
  view.activities[3].behind_since = began - 33;
  view.activities[4].last_status = 429;
  view.activities[4].throttled = 3;
  view.activities[4].last_sentence = "\"Cloud updates too frequent. Reduce to <1Hz.\"";
  view.activities[5].last_forwarded = began - 200;
  view.activities[5].last_accepted = began - 201;
  view.activities[9].refused_upstream = 2;
  view.activities[9].last_status = 422;
  view.activities[9].last_sentence = "\"Missing field: 'pose'\"";
  view.reports.insert(view.reports.begin(), {report(10, "Helmet", now - 1, "queued", 0, {}),
                                             report(9, "Cube", now - 3, "sending", 0, {}),
                                             report(8, "Vent", now - 42, "in_doubt", 0, {})});
  view.reports[2].note = "the connection was lost before an answer came";
  view.refusals.push_back(
      {began - 20, "/state/update", "10.0.0.8", 422,
       R"(msg.header.frame_id: expected "darpa", got "map" (the setting rules.rewrite_frame_id accepts any frame))",
       0, "rules.rewrite_frame_id"});
  view.alarms = {
      alarm("command_post_unreachable", alarms::Severity::Bad, began - 130, "Mapping is unreachable",
            "connecting to 10.100.1.201:8000: Connection refused; the box tries again",
            {"Open test", "/setup#test"}),
      alarm("report_in_doubt:8", alarms::Severity::Ask, now - 42, "Report 8 is in doubt",
            "the connection was lost before an answer came", {"Decide", "/#report=8"}),
      alarm("reports_left", alarms::Severity::Wait, began - 9, "5 reports are left", "in this run", {})};
  view.alarms[0].hides = 3;
  return view;
}

/// A report in every state, after a new run began.
RunView reports(Time now, double elapsed) {
  RunView view = calm(now, elapsed);
  view.run_number = 2;
  view.run_id = "cave-2";
  view.reports = {report(28, "Drill", now - 1, "queued", 0, {}),
                  report(27, "Cube", now - 2, "sending", 0, {}),
                  report(26, "Vent", now - 12, "in_doubt", 0, {}),
                  report(25, "Gas", now - 60, "in_doubt", 0, {}),
                  report(24, "Rope", now - 80, "held", 0, {}),
                  report(23, "Helmet", now - 90, "settled", 201, 1),
                  report(22, "Helmet", now - 95, "settled", 0, {}),
                  report(21, "Backpack", now - 100, "withdrawn", 0, {}),
                  report(20, "Backpack", now - 110, "withdrawn", 0, {}),
                  report(19, "Survivor", now - 120, "rejected", 422, {}),
                  report(18, "Survivor", now - 900, "answered", 201, 1)};
  for (facts::ReportRow& row : view.reports) row.run = row.number == 18 ? 1 : 2;
  view.reports[4].position = {306.25, -2.5, 0.25};  // near report 25, of the same type
  view.reports[4].type = "Gas";
  view.reports[2].asking = true;
  view.reports[2].note = "the connection was lost before an answer came; the run's status is being asked";
  view.reports[3].note = "no answer came, and the run's status shows that another client reports, too";
  view.reports[4].note = "the same type as report 25, 2 m from it";
  view.reports[5].reconciled = true;
  view.reports[6].note = "the operator settled it";
  view.reports[7].same_as = 17;
  view.alarms = {alarm("report_in_doubt:25", alarms::Severity::Ask, now - 60, "Report 25 is in doubt",
                       "no answer came", {"Decide", "/#report=25"}),
                 alarm("report_held:24", alarms::Severity::Ask, now - 80, "Report 24 is held",
                       "the same type as report 25, 2 m from it", {"Decide", "/#report=24"})};
  return view;
}

RunView hostile(Time now, double elapsed) {
  RunView view = calm(now, elapsed);
  const std::string script = "<img src=x onerror=\"window.pwned=1\"><script>window.pwned=1</script>";
  const std::string endless(3000, 'W');
  view.version = script;
  view.run = icd::RunStatus{-999'999'999, 1e12, -1, script + endless};
  view.run_clock->seconds = 1e12;
  for (facts::ActivityRow& row : view.activities) row.robot = row.kind == "markers" ? "" : script + row.robot;
  view.activities[0].last_sentence = endless;
  view.activities[1].last_sentence = "\xff\xfe \u202e" + script;
  view.activities[1].kind = "__proto__";
  view.reports[0].type = endless;
  view.reports[1].type = script;
  view.reports[1].position = {1e308, -1e308, 5e-324};
  view.reports[2].state = script;
  view.reports[3].note = endless;
  view.refusals.push_back({now - 1, script, endless, 422, script + endless});
  view.refusals.push_back({now - 1, script, endless, 422, script});
  view.endpoints[0].trouble = script + endless;
  view.robots.push_back({script + endless, {1e308, -1e308, 0}, 1e300, now});
  view.lights[0].pattern = script;
  view.lights[1].name = endless.substr(0, 300);
  view.alarms = {alarm("robot_silent:" + script, alarms::Severity::Bad, 0, script + endless, script + endless,
                       {script + endless, "javascript:window.pwned=1"})};
  view.alarms_over = {{.id = script, .was = script + endless, .since = -1e308, .until = 1e308}};
  view.budget_mbit = 0;
  view.sent_mbit = 1e300;
  return view;
}

}  // namespace

std::optional<RunView> scene(std::string_view name, Time now, double elapsed) {
  constexpr struct {
    std::string_view name;
    RunView (*made)(Time now, double elapsed);
  } kScenes[] = {{"empty", [](Time at, double) { return empty(at); }},
                 {"calm", calm},
                 {"trouble", trouble},
                 {"reports", reports},
                 {"hostile", hostile}};
  for (const auto& each : kScenes) {
    if (each.name != name) continue;
    RunView view = each.made(now, elapsed);
    facts::Traffic traffic{
        .now = now, .endpoints = view.endpoints, .activities = view.activities, .robots = view.robots};
    for (facts::ActivityRow& row : traffic.activities) facts::set_ages(row, now);
    alarms::add_words(traffic, view.alarms);
    view.verdict = alarms::verdict_of(traffic);
    view.endpoints = std::move(traffic.endpoints);
    view.activities = std::move(traffic.activities);
    view.robots = std::move(traffic.robots);
    view.standings = std::move(traffic.standings);
    return view;
  }
  return {};
}

}  // namespace adit::api
