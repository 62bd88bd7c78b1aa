// The JSON of the API's rows, byte for byte. Scripts and pages depend on names, order and number formats.
#include <gmock/gmock.h>

#include "api/box.hpp"
#include "api/keys.hpp"
#include "api/map_json.hpp"
#include "api/map_scene.hpp"
#include "api/run_view.hpp"
#include "api/settings_rows.hpp"

namespace adit::api {
namespace {

facts::ReportRow report() {
  facts::ReportRow row;
  row.number = 7;
  row.type = "Rope";
  row.position = icd::Point{.x = 1, .y = -2.5, .z = 0};
  row.sender = "10.0.0.7";
  row.robot = "spot1";
  row.received = 940;
  row.changed = 941.25;
  row.state = "in_doubt";
  row.status = 500;
  row.report_status = "scored";
  row.score_change = -1;
  row.note = "no \"answer\"";
  row.run = 2;
  row.asking = true;
  row.reconciled = true;
  row.same_as = 3;
  row.sends_at = 950;
  return row;
}

RunView view() {
  RunView view;
  view.now = 1000.5;
  view.version = "0.1";
  view.run = {.score = 7, .run_clock = 754.5, .remaining_reports = 18, .current_team = "cave"};
  view.run_clock = {.seconds = 756, .age = 1.5, .runs = true};
  view.run_number = 2;
  view.run_id = "beta";
  view.endpoints = {{.name = "scoring",
                     .address = "a:1",
                     .connected = true,
                     .trouble = "t",
                     .last_status = 201,
                     .answer_ms = 3.5,
                     .answered = 4,
                     .throttled = 1,
                     .foreign = 2,
                     .level = facts::Level::Bad,
                     .word = "w"},
                    {.name = "mapping", .address = "b:1"}};
  view.robots = {{.name = "r", .position = {1, 2, 3}, .heading = 0.5, .at = 990, .age = 19}};
  view.reports = {report(), {}};
  view.near_metres = 5;
  facts::ActivityRow activity;
  activity.kind = "grid", activity.robot = "r", activity.accepted = 1, activity.forwarded = 2;
  activity.replaced = 3, activity.merged = 4;
  activity.throttled = 5, activity.failed = 6, activity.refused_upstream = 7, activity.queued = 8;
  activity.no_room = 13, activity.behind_since = 14, activity.last_no_room = 15;
  activity.age = 17, activity.heard = 18;
  activity.last_accepted = 9, activity.bytes_received = 10, activity.bytes_sent = 11;
  activity.last_status = 12, activity.last_sentence = "said", activity.clouds = "parts",
  activity.precision = "1mm", activity.no_valid_point = 20;
  activity.invisible = 21;
  activity.arrival = facts::Arrival::Late, activity.level = facts::Level::Wait;
  activity.word = "17 s behind";
  view.activities = {activity};
  view.standings = {
      {.name = "r", .level = facts::Level::Wait, .word = "w", .has_map = true, .age = 22, .heard = 23}};
  view.colours = {{"r", 2}};
  view.refusals = {
      {.at = 1, .uri = "/u", .sender = "s", .status = 422, .sentence = "no", .parts = 2, .setting = "r.m"}};
  view.rejected = {{.number = 1,
                    .kind = "grid",
                    .robot = "r",
                    .at = 2,
                    .status = 400,
                    .why = "w",
                    .bytes = 3,
                    .replaced = true}};
  view.lights = {{.name = "health", .pattern = "on"}};
  view.links = {{.side = "team", .interface = "team0", .carrier = true},
                {.side = "command_post", .interface = "d", .carrier = std::nullopt}};
  view.certificate = "AB:CD";
  view.identify_until = 1001;
  view.budget_mbit = 100, view.sent_mbit = 1.5, view.queued_bytes = 6;
  view.map_version = 1'793'000'123'456, view.marker_version = 4;
  view.verdict = {facts::Level::Bad, "w", "y"};
  view.alarms = {{.id = "i:s",
                  .severity = alarms::Severity::Ask,
                  .side = alarms::Side::CommandPost,
                  .subject = "s",
                  .since = 3,
                  .what = "what",
                  .why = "why",
                  .details = "why: details",
                  .action = {"word", "/link"},
                  .acknowledged = true,
                  .hides = 4}};
  view.alarms_over = {{.id = "o", .side = alarms::Side::Robot, .was = "was", .since = 5, .until = 6}};
  return view;
}

constexpr const char* kReport =
    R"({"number":7,"type":"Rope","position":{"x":1.0,"y":-2.5,"z":0.0},"sender":"10.0.0.7",)"
    R"("robot":"spot1","received":940.0,"changed":941.25,"state":"in_doubt","status":500,)"
    R"("report_status":"scored","score_change":-1,"note":"no \"answer\"","run":2,"asking":true,)"
    R"("reconciled":true,"same_as":3,"sends_at":950.0})";

TEST(Bytes, OfARun) {
  EXPECT_EQ(
      codec::to_json(view()),
      R"({"now":1000.5,"version":"0.1","run":{"score":7,"run_clock":754.5,"remaining_reports":18,)"
      R"("current_team":"cave"},"run_clock":{"seconds":756.0,"age":1.5,"runs":true,)"
      R"("old":false},"run_number":2,"run_id":"beta","run_seconds":3600,)"
      R"("endpoints":[{"name":"scoring","address":"a:1","connected":true,"trouble":"t",)"
      R"("last_status":201,"answer_ms":3.5,"answered":4.0,"throttled":1,"foreign":2,"level":"bad","word":"w"},{"name":"mapping",)"
      R"("address":"b:1","connected":false,"trouble":"","last_status":0,"answer_ms":null,"answered":null,)"
      R"("throttled":0,"foreign":0,"level":"quiet","word":""}],"robots":[{"name":"r","position":{"x":1.0,"y":2.0,"z":3.0},)"
      R"("heading":0.5,"at":990.0,"age":19.0}],"reports":[{"number":7,"type":"Rope","position":{"x":1.0,)"
      R"("y":-2.5,"z":0.0},"sender":"10.0.0.7","robot":"spot1","received":940.0,"changed":941.25,)"
      R"("state":"in_doubt","status":500,"report_status":"scored","score_change":-1,)"
      R"("note":"no \"answer\"","run":2,"asking":true,"reconciled":true,"same_as":3,"sends_at":950.0},{"number":0,)"
      R"("type":"","position":{"x":0.0,"y":0.0,"z":0.0},"sender":"","robot":"","received":0.0,"changed":0.0,)"
      R"("state":"","status":0,"report_status":"","score_change":null,"note":"","run":1,)"
      R"("asking":false,"reconciled":false,"same_as":0,"sends_at":null}],"near_metres":5.0,)"
      R"("activities":[{"kind":"grid","robot":"r","accepted":1,"forwarded":2,"replaced":3,)"
      R"("merged":4,"throttled":5,"failed":6,"refused_upstream":7,"no_room":13,"queued":8,)"
      R"("behind_since":14.0,"age":17.0,"last_accepted":9.0,"last_forwarded":null,"heard":18.0,"last_no_room":15.0,"bytes_received":10,"bytes_sent":11,"last_status":12,)"
      R"("last_sentence":"said","clouds":"parts","precision":"1mm","no_valid_point":20,)"
      R"("invisible":21,)"
      R"("arrival":"late","level":"wait","word":"17 s behind"}],"standings":[{"name":"r","level":"wait",)"
      R"("word":"w","silent":false,"has_map":true,"age":22.0,"heard":23.0}],"colours":[{"name":"r","colour":2}],"refusals":[{"at":1.0,"uri":"/u","sender":"s","status":422,)"
      R"("sentence":"no","parts":2,"setting":"r.m"}],"rejected":[{"number":1,"kind":"grid","robot":"r","at":2.0,)"
      R"("status":400,"why":"w","bytes":3,"replaced":true}],"lights":[{"name":"health",)"
      R"("pattern":"on"}],"links":[{"side":"team","interface":"team0","carrier":true},)"
      R"({"side":"command_post","interface":"d","carrier":null}],"certificate":"AB:CD","identify_until":1001.0,)"
      R"("setup_open_until":null,"budget_mbit":100.0,"sent_mbit":1.5,"queued_bytes":6,)"
      R"("map_version":1793000123456,"marker_version":4,)"
      R"("verdict":{"level":"bad","what":"w","why":"y"},"alarms":[{"id":"i:s","severity":"ask",)"
      R"("side":"command_post","subject":"s","since":3.0,"what":"what","why":"why",)"
      R"("details":"why: details",)"
      R"("action":{"word":"word","link":"/link"},"acknowledged":true,"hides":4}],)"
      R"("alarms_over":[{"id":"o","severity":"bad","side":"robot","was":"was","since":5.0,)"
      R"("until":6.0}]})");
}

TEST(Bytes, OfReports) {
  EXPECT_EQ(codec::to_json(std::vector{report()}), std::string("[") + kReport + "]");
  EXPECT_EQ(codec::to_json(std::vector<facts::ReportRow>()), "[]");
  EXPECT_EQ(
      codec::to_json(ReportDetail{
          .row = report(), .history = {{.at = 1, .state = "queued", .note = "n"}}, .answer = "{}"}),
      R"({"number":7,"type":"Rope","position":{"x":1.0,"y":-2.5,"z":0.0},"sender":"10.0.0.7",)"
      R"("robot":"spot1","received":940.0,"changed":941.25,"state":"in_doubt","status":500,)"
      R"("report_status":"scored","score_change":-1,"note":"no \"answer\"","run":2,"asking":true,)"
      R"("reconciled":true,"same_as":3,"sends_at":950.0,"history":[{"at":1.0,"state":"queued","note":"n"}],)"
      R"("answer":"{}"})");
}

TEST(Bytes, OfTheBox) {
  About about;
  about.version = "1", about.build = "b", about.licence = "Apache-2.0", about.started = 10,
  about.uptime = 2.5;
  about.kernel = "k", about.model = "m";
  about.parts = {{.name = "zlib", .version = "1.2", .licence = "Zlib"}};
  EXPECT_EQ(codec::to_json(about),
            R"({"version":"1","build":"b","licence":"Apache-2.0","started":10.0,"uptime":2.5,)"
            R"("kernel":"k","model":"m","board":null,"parts":[{"name":"zlib","version":"1.2",)"
            R"("licence":"Zlib"}]})");
  about.board = {"rock-pi-e", "ROCK Pi E"};
  EXPECT_EQ(codec::to_json(about),
            R"({"version":"1","build":"b","licence":"Apache-2.0","started":10.0,"uptime":2.5,)"
            R"("kernel":"k","model":"m","board":{"name":"rock-pi-e","title":"ROCK Pi E"},)"
            R"("parts":[{"name":"zlib","version":"1.2","licence":"Zlib"}]})");
  EXPECT_EQ(
      codec::to_json(NetworkState{
          .interfaces = {{.name = "e", .up = true, .carrier = std::nullopt, .addresses = {"10.0.0.1/24"}}},
          .routes = {{.destination = "d", .gateway = "", .interface = "e", .metric = 5}},
          .trouble = ""}),
      R"({"interfaces":[{"name":"e","up":true,"carrier":null,"addresses":["10.0.0.1/24"]}],)"
      R"("routes":[{"destination":"d","gateway":"","interface":"e","metric":5}],"trouble":""})");
  EXPECT_EQ(codec::to_json(LogPage{.last = 9,
                                   .records = {{.seq = 4,
                                                .at = 1.5,
                                                .severity = 6,
                                                .level = "info",
                                                .message = "m",
                                                .fields = {{"k", "v"}},
                                                .line = "l"}}}),
            R"({"last":9,"records":[{"seq":4,"at":1.5,"level":"info","message":"m","fields":{"k":"v"}}]})");
}

TEST(Bytes, OfTheScene) {
  EXPECT_EQ(codec::to_json(MarkerChanges{.version = 5,
                                         .whole = false,
                                         .left_out = 2,
                                         .markers = {{drawn_marker(), 99.5}},
                                         .gone = {{"path", 7}}}),
            R"({"version":5,"whole":false,"left_out":2,"markers":[{"ns":"path","id":-3,"type":4,)"
            R"("position":{"x":1.0,"y":2.0,"z":3.0},"heading":1.57,"scale":{"x":4.0,"y":5.0,"z":6.0},)"
            R"("color":{"r":0.5,"g":0.25,"b":1.0,"a":0.13},"points":[1.0,2.0,-3.46,4.0],)"
            R"("colors":["#ff0080ff"],"point_count":7000,"text":"here","mesh":"drill","lifetime":2.5,)"
            R"("at":99.5}],"gone":[{"ns":"path","id":7}]})");
  EXPECT_EQ(codec::to_json(
                Tracks{{{.robot = "r", .poses = {{.at = 1.239, .position = {1, 2, 3}, .heading = 0.5}}}}}),
            R"({"tracks":[{"robot":"r","poses":[[1.24,1.0,2.0,3.0,0.5]]}]})");
}

TEST(Bytes, OfTheMap) {
  picture::Mosaic map;
  draw_scene(map, 2000);
  const std::string text = codec::to_json(map_view(map, 0));
  EXPECT_THAT(
      text,
      testing::StartsWith(
          R"({"version":2000000,"tile_side":256,"metres_per_pixel":[0.25,1.0,4.0],)"
          R"("finer_metres_per_pixel":[0.05,0.01],)"
          R"("colours":{"free":"#c8d2da","occupied":"#a8321e","heights":["#472c7a","#3b518b","#2c718e",)"
          R"("#21908d","#27ad81","#5cc863","#aadc32","#fde725"]},"spacing":1.0,"wiped":null,)"
          R"("missed":0,"layers":[{"robot":"","kind":"grid","bounds":{"left":-10.0,"bottom":-5.5,"right":230.0,)"
          R"("top":152.5},"heights":null,"first":1429.0,"last":1999.0,"version":1999000,"missed":0,)"
          R"("left_out":0,"finer":null,"tiles":[{"level":0,"x":-1,"y":0,"first":1429.0,"stamp":1429.0,)"
          R"("version":1429000,"blank":false})"));
  EXPECT_THAT(text, testing::HasSubstr(R"("heights":{"low":)"));
  EXPECT_EQ(text.size(), 3228u);
}

TEST(Bytes, OfTheSession) {
  EXPECT_EQ(codec::to_json(std::vector{SessionRow{.number = 3,
                                                  .role = access::Role::Operator,
                                                  .address = "10.0.0.7",
                                                  .agent = "curl",
                                                  .made = 940,
                                                  .seen = 941.5,
                                                  .own = true}}),
            R"([{"number":3,"role":"operator","address":"10.0.0.7","agent":"curl","made":940.0,)"
            R"("seen":941.5,"own":true}])");
  EXPECT_EQ(
      codec::to_json(SessionView{.role = std::nullopt, .csrf = "", .first_start = true}),
      R"({"role":null,"csrf":null,"first_start":true,"set_up_open":false,"secure":false,"https":false})");
  EXPECT_EQ(
      codec::to_json(
          SessionView{.role = access::Role::Viewer, .csrf = "c", .set_up_open = true, .https = true}),
      R"({"role":"viewer","csrf":"c","first_start":false,"set_up_open":true,"secure":false,"https":true})");
}

TEST(Bytes, OfTheSettings) {
  const KeyRow whole{.path = "p",
                     .meaning = "m",
                     .kind = "whole",
                     .required = true,
                     .default_value = {},
                     .range = "1 to 2",
                     .least = {std::int64_t{1}},
                     .most = {std::int64_t{2}}};
  const KeyRow choice{.path = "q",
                      .meaning = "n",
                      .kind = "choice",
                      .default_value = {"a"},
                      .range = "a or b",
                      .words = std::vector<std::string>{"a", "b"}};
  EXPECT_EQ(codec::to_json(SetupView{.settings = {codec::Value::Object{{"version", {std::int64_t{1}}}}},
                                     .tag = "t",
                                     .saved = true,
                                     .trouble = "",
                                     .tokens = {{"team", true}, {"scoring", false}},
                                     .keys = {whole, choice}}),
            R"({"settings":{"version":1},"tag":"t","saved":true,"applying":false,"trouble":"",)"
            R"("tokens":{"team":true,"scoring":false},"odd_tokens":[],)"
            R"("keys":[{"path":"p","meaning":"m","kind":"whole",)"
            R"("required":true,"default":null,"range":"1 to 2","least":1,"most":2},{"path":"q",)"
            R"("meaning":"n","kind":"choice","required":false,"default":"a","range":"a or b",)"
            R"("words":["a","b"]}]})");
  const ChangesView changes{.changes = {{"p", {}, {0.5}}}, .warnings = {"w"}};
  EXPECT_EQ(codec::to_json(changes), R"({"changes":[{"path":"p","from":null,"to":0.5}],"warnings":["w"]})");
  EXPECT_EQ(
      codec::to_json(CheckView{.errors = {{"p", "wrong"}}, .changes = changes}),
      R"({"errors":[{"path":"p","what":"wrong"}],"changes":[{"path":"p","from":null,"to":0.5}],"warnings":["w"]})");
}

}  // namespace
}  // namespace adit::api
