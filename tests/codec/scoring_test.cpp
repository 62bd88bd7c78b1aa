// The scoring endpoint's messages in both directions (ICD 5).
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "codec/icd_row.hpp"
#include "codec/messages.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"

namespace adit::codec {
namespace {

using test::IcdRow;
using test::json;

icd::Checked<ReadReport> read_with_name(const std::string& body, const icd::Rules& rules = {}) {
  const auto document = decode({}, Split::Nothing, body);
  if (!document) return std::unexpected(document.error());
  return read_artifact_report(*document, rules);
}

icd::Checked<icd::ArtifactReport> read_report(const std::string& body, const icd::Rules& rules = {}) {
  auto read = read_with_name(body, rules);
  if (!read) return std::unexpected(std::move(read.error()));
  return std::move(read->report);
}

template <class Reply>
std::string why_not(const std::expected<Reply, std::string>& reply) {
  return reply ? "understood" : reply.error();
}

const std::string kTheTen =
    "type: expected one of Survivor, Cell Phone, Backpack, Drill, Fire Extinguisher, Gas, Vent, Helmet, "
    "Rope, "
    "Cube, got ";

TEST(ReadArtifactReport, RejectsAForbiddenReport) {
  const IcdRow rows[] = {
      {"5.2", [](json&) {}, "accepted"},
      {"5.2", [](json& m) { m["name"] = "robot1"; }, "accepted"},  // as in the ICD's example
      {"5.2", [](json& m) { m["x"] = 1011; }, "accepted"},
      {"5.2", [](json& m) { m = {1}; }, "the body: expected an object, got an array"},
      {"5.2", [](json& m) { m.erase("x"); }, "x: missing"},
      {"5.2", [](json& m) { m.erase("y"); }, "y: missing"},
      {"5.2", [](json& m) { m.erase("z"); }, "z: missing"},
      {"5.2", [](json& m) { m = json::object(); }, "x, y, z, type: missing"},
      {"5.2", [](json& m) { m = {{"position", {{"x", 1}, {"y", 2}, {"z", 3}}}, {"type", "Rope"}}; },
       "x, y, z: missing (found position: put the position's x, y and z here)"},
      {"5.2", [](json& m) { m.erase("x"), m["y"] = "1"; }, "x: missing"},
      {"5.2", [](json& m) { m["x"] = "1", m.erase("y"); }, "x: expected a number, got a string"},
      {"5.2", [](json& m) { m["y"] = "1"; }, "y: expected a number, got a string"},
      {"5.2", [](json& m) { m["z"] = nullptr; }, "z: expected a number, got null"},
      {"5.2", [](json& m) { m["z"] = false; }, "z: expected a number, got true or false"},
      {"5.2", [](json& m) { m.erase("type"); }, "type: missing"},
      {"5.2", [](json& m) { m["type"] = 1; }, "type: expected a string, got a whole number"},
      {"5.2", [](json& m) { m["type"] = "CELL pHone"; }, "accepted"},
      {"5.2", [](json& m) { m["type"] = "test"; },
       kTheTen + "\"test\" (the setting rules.forward_unknown_types accepts others)"},
      {"5.2", [](json& m) { m["type"] = ""; }, kTheTen + "\"\""},
      {"5.2", [](json& m) { m["type"] = "Rope\n"; }, kTheTen + "\"Rope?\"; did you mean Rope?"},
      {"5.2", [](json& m) { m["type"] = "Cellphone"; }, kTheTen + "\"Cellphone\"; did you mean Cell Phone?"},
      {"5.2", [](json& m) { m["type"] = "Cell\nPhone"; },
       kTheTen + "\"Cell?Phone\"; did you mean Cell Phone?"},
  };
  for (const IcdRow& row : rows) {
    json message = test::good_report();
    row.change(message);
    EXPECT_EQ(test::sentence_of(read_report(message.dump())), row.sentence) << "ICD " << row.section;
  }
}

TEST(ReadArtifactReport, RejectsAMemberGivenTwice) {
  EXPECT_EQ(test::sentence_of(read_report(R"({"x":1,"y":2,"z":3,"x":4,"type":"Rope"})")), "x: given twice");
  EXPECT_EQ(test::sentence_of(read_report(R"({"x":1,"y":2,"z":3,"type":"Gas","type":"Rope"})")),
            "type: given twice");
}

TEST(ReadArtifactReport, AcceptsOtherTypesIfTheSettingsForwardThem) {
  icd::Rules rules;
  rules.forward_unknown_types = true;
  const auto answer = [&](const std::string& type) {
    json message = test::good_report();
    message["type"] = type;
    return test::sentence_of(read_report(message.dump(), rules));
  };
  EXPECT_EQ(answer("test"), "accepted");
  EXPECT_EQ(answer(std::string(64, 'a')), "accepted");
  EXPECT_EQ(answer(""), "type: expected 1 to 64 printable ASCII characters, got \"\"");
  EXPECT_EQ(answer("a\tb"), "type: expected 1 to 64 printable ASCII characters, got \"a?b\"");
  EXPECT_TRUE(answer(std::string(65, 'a')).starts_with("type: expected 1 to 64 printable ASCII characters"));
}

TEST(ReadArtifactReport, KeepsTheSpellingOfTheType) {
  const auto report = read_report(test::good_report().dump());
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(*report, (icd::ArtifactReport{.type = "backpack", .position = {1011.242, -244.433, -10.011}}));
}

TEST(ReadArtifactReport, NamesTheSettingThatWouldAcceptTheType) {
  const auto setting = [](const std::string& type) {
    return read_report(R"({"x":1,"y":2,"z":3,"type":")" + type + R"("})").error().setting;
  };
  EXPECT_EQ(setting("test"), "rules.forward_unknown_types");
  EXPECT_EQ(setting("Cellphone"), "") << "a misspelt type";
  EXPECT_EQ(setting(""), "");
}

TEST(ReadArtifactReport, ReadsTheNamedRobot) {
  icd::Rules rules;
  rules.aliases.emplace("the dog", *icd::RobotName::parse("spot1"));
  const auto named = [&rules](const std::string& member) {
    const auto read = read_with_name(R"({"x":1,"y":2,"z":3,"type":"Rope")" + member + "}", rules);
    if (!read) return "refused: " + read.error().sentence;
    return (read->report.robot ? read->report.robot->text() : "none") + "|" + read->left_out;
  };
  const std::string expected = "none|name: expected 1 to 10 letters, digits and underscores, got ";
  const std::string cure = " (the setting robots[].alias can map this name to a valid one)";
  EXPECT_EQ(named(R"(,"name":"robot_1")"), "robot_1|");
  EXPECT_EQ(named(R"(,"name":"the dog")"), "spot1|");
  EXPECT_EQ(named(""), "none|");
  EXPECT_EQ(named(R"(,"name":null)"), "none|");
  EXPECT_EQ(named(R"(,"name":"")"), expected + "\"\"");
  EXPECT_EQ(named(R"(,"name":"no robot")"), expected + "\"no robot\"" + cure);
  EXPECT_EQ(named(R"(,"name":"eleven_1234")"), expected + "\"eleven_1234\"" + cure);
  EXPECT_EQ(named(R"(,"name":7)"), "none|name: expected a string, got a whole number");
  EXPECT_EQ(named(R"(,"name":["r1"])"), "none|name: expected a string, got an array");
  EXPECT_EQ(named(R"(,"name":"r1","name":"r2")"), "none|name: given twice");
}

TEST(WriteArtifactReport, WritesTheIcdsExample) {
  icd::ArtifactReport report{.type = "backpack", .position = {1011.242, -244.433, -10.011}};
  EXPECT_EQ(write_artifact_report(report),
            R"({"x": 1011.242, "y": -244.433, "z": -10.011, "type": "backpack"})");
  report.robot = icd::RobotName::parse("robot1");
  EXPECT_EQ(write_artifact_report(report),
            R"({"x": 1011.242, "y": -244.433, "z": -10.011, "type": "backpack", "name": "robot1"})");
}

TEST(WriteArtifactReport, WritesFloatsAsFloats) {  // ICD 5.2; some servers reject an integer
  const auto written = [](const char* x) {
    const auto report = read_report(std::string(R"({"x":)") + x + R"(,"y":0,"z":-0.0,"type":"Rope"})");
    return report ? write_artifact_report(*report) : report.error().sentence;
  };
  const auto expected = [](const char* x) {
    return std::string(R"({"x": )") + x + R"(, "y": 0.0, "z": -0.0, "type": "Rope"})";
  };
  for (const auto& [came, goes] : {std::pair{"11.0", "11.0"},
                                   {"11", "11.0"},
                                   {"-7.50", "-7.5"},
                                   {"1e3", "1000.0"},
                                   {"1e300", "1e+300"},
                                   {"9007199254740993", "9007199254740992.0"},
                                   {"123456789012345678901234567890", "1.2345678901234568e+29"}}) {
    EXPECT_EQ(written(came), expected(goes));
  }
}

TEST(WriteArtifactReport, WritesDoublesThatReadBackTheSame) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 2000; ++round) {
    const auto number = [&random] {
      double made = std::numeric_limits<double>::quiet_NaN();
      while (!std::isfinite(made)) {
        const std::uint64_t bits = random();
        std::memcpy(&made, &bits, sizeof made);
      }
      return made;
    };
    const icd::ArtifactReport report{
        .type = "Rope", .position = {number(), number(), number()}, .robot = icd::RobotName::parse("r1")};
    const std::string body = write_artifact_report(report);
    const auto again = read_report(body);
    ASSERT_TRUE(again.has_value()) << body;
    EXPECT_EQ(*again, report) << body;
    const json by_another = json::parse(body);
    EXPECT_EQ(by_another["x"].get<double>(), report.position.x);
  }
}

TEST(WriteArtifactReport, WritesJsonForAnyValues) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const json body = json::parse(write_artifact_report(
      {.type = "a\"\n\xff", .position = {nan, 1, -std::numeric_limits<double>::infinity()}}));
  EXPECT_TRUE(body["x"].is_null());
  EXPECT_TRUE(body["z"].is_null());
  EXPECT_EQ(body["type"], "a\"\n\xef\xbf\xbd");
}

TEST(JsonString, EscapesControlsAndReplacesInvalidUtf8) {
  EXPECT_EQ(json_string("Missing field 'type'"), "\"Missing field 'type'\"");
  EXPECT_EQ(json_string(""), "\"\"");
  EXPECT_EQ(json_string("a\"b\\c"), R"("a\"b\\c")");
  EXPECT_EQ(json_string("\n\r\t"), R"("\n\r\t")");
  EXPECT_EQ(json_string(std::string("\0\x1f\x7f", 3)), R"("\u0000\u001f\u007f")");
  EXPECT_EQ(json_string("\xc3\xa9\xf0\x9f\xa4\x96"), "\"\xc3\xa9\xf0\x9f\xa4\x96\"");
  EXPECT_EQ(json_string("a\xff"), "\"a\xef\xbf\xbd\"");
  EXPECT_EQ(json_string("\xc3"), "\"\xef\xbf\xbd\"");
  EXPECT_EQ(json_string("\xc3(\""), "\"\xef\xbf\xbd(\\\"\"");
  EXPECT_EQ(json_string("\xed\xa0\x80"), "\"\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\"");  // a surrogate
}

TEST(JsonString, IsJsonForAnyBytes) {
  std::mt19937_64 random(6);
  for (int round = 0; round < 3000; ++round) {
    std::string bytes;
    for (std::size_t i = random() % 20; i > 0; --i) bytes += static_cast<char>(random());
    EXPECT_TRUE(json::accept(json_string(bytes))) << testing::PrintToString(bytes);
  }
}

TEST(ReadRunStatus, ReadsTheClockByEitherName) {
  const icd::RunStatus expected{
      .score = 6, .run_clock = 721.4, .remaining_reports = 14, .current_team = "subt"};
  EXPECT_EQ(
      read_run_status(R"({"score": 6, "clock": 721.4, "remaining_reports": 14, "current_team": "subt"})"),
      expected);  // ICD 5.1's example
  EXPECT_EQ(
      read_run_status(R"({"score": 6, "run_clock": 721.4, "remaining_reports": 14, "current_team": "subt"})"),
      expected);  // ICD 5.1's table
}

TEST(ReadRunStatus, NamesTheFault) {
  const auto why = [](std::string_view body) { return why_not(read_run_status(body)); };
  EXPECT_EQ(why(R"({"score": 6, "run_clock": 0, "remaining_reports": 14})"), "understood");
  EXPECT_EQ(why(R"({"run_clock": 0, "remaining_reports": 14})"), "score: missing");
  EXPECT_EQ(why(R"({"score": 6, "run_clock": 0})"), "remaining_reports: missing");
  EXPECT_EQ(why(R"({"score": 6, "remaining_reports": 14})"), "run_clock: missing");
  EXPECT_EQ(why(R"({"score": "6", "run_clock": 0, "remaining_reports": 14})"),
            "score: expected a whole number, got a string");
  EXPECT_EQ(why(R"({"score": 9e18, "run_clock": 0, "remaining_reports": 14})"),
            "score: expected a whole number from -2147483648 to 2147483647, got 9e+18");
  EXPECT_EQ(why(R"({"score": 6, "run_clock": 0, "remaining_reports": -9223372036854775808})"),
            "remaining_reports: expected a whole number from -2147483648 to 2147483647, got "
            "-9223372036854775808");
  EXPECT_EQ(why("\"no\""), "the body: expected an object, got a string");
  EXPECT_NE(why("<html>"), "understood");
  EXPECT_NE(why(""), "understood");
}

TEST(ReadReportReply, AcceptsTheExampleOfTheIcdAndOfServers) {
  const icd::ReportReply expected{.run = "1",
                                  .run_clock = 721.4,
                                  .report_status = "scored",
                                  .score_change = 1,
                                  .report = icd::ArtifactReport{"backpack", {1011.242, -244.433, -10.011}}};
  const std::string start =
      R"({"url": "http://<ipaddress>:<port>/api/artifact_reports/1", "id": 1, "x": 1011.242, "y": -244.433, )"
      R"("z": -10.011, "type": "backpack", "submitted_datetime": "2019-01-01T00:00:00.000000-07:00", )"
      R"("run_clock": 721.4, "team": "subt", "run": )";
  const std::string end = R"(, "report_status": "scored", "score_change": 1})";
  EXPECT_EQ(read_report_reply(start + "1" + end), expected);
  EXPECT_EQ(read_report_reply(start + "\"1\"" + end), expected);
  EXPECT_EQ(read_report_reply(start + "\"1.5.2\"" + end).value().run, "1.5.2");
  EXPECT_EQ(read_report_reply(start + "1.5" + end).value().run, "1.5");
}

TEST(ReadReportReply, AcceptsMissingOptionalMembers) {
  const icd::ReportReply least{.run = "", .report_status = "admin stop", .score_change = 0};
  EXPECT_EQ(read_report_reply(R"({"report_status": "admin stop", "score_change": 0})"), least);
  EXPECT_EQ(read_report_reply(R"({"id": "a-7", "run": null, "team": 5.0e300, "run_clock": null,
                                  "report_status": "admin stop", "score_change": 0.0})")
                .value()
                .report_status,
            "admin stop");
}

TEST(ReadReportReply, NamesTheFault) {
  const auto why = [](std::string_view body) { return why_not(read_report_reply(body)); };
  EXPECT_EQ(why(R"({"score_change": 0})"), "report_status: missing");
  EXPECT_EQ(why(R"({"report_status": "scored"})"), "score_change: missing");
  EXPECT_EQ(why(R"({"report_status": 1, "score_change": 0})"),
            "report_status: expected a string, got a whole number");
  EXPECT_EQ(why(R"({"report_status": "scored", "score_change": 0.5})").substr(0, 13), "score_change:");
  EXPECT_EQ(why(R"({"report_status": "scored", "score_change": 9e18})"),
            "score_change: expected a whole number from -2147483648 to 2147483647, got 9e+18");
  EXPECT_EQ(why("[]"), "the body: expected an object, got an array");
  EXPECT_NE(why("502 Bad Gateway"), "understood");
}

}  // namespace
}  // namespace adit::codec
