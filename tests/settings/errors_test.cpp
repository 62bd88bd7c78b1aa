#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <span>

#include "settings/sample.hpp"
#include "settings/settings.hpp"

namespace adit::settings {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

std::vector<std::string> errors_of(const std::string& json) {
  const auto settings = parse(json);
  std::vector<std::string> sentences;
  if (settings) return sentences;
  for (const Error& error : settings.error()) sentences.push_back(error.sentence());
  return sentences;
}

std::string scoring(const std::string& address, const std::string& port) {
  return R"({"version": 1, "command_post": {"scoring": {"address": )" + address + R"(, "port": )" + port +
         R"(}, "mapping": {"address": "10.100.1.201", "port": 8000}},)"
         R"("team": {"listen": [{"address": "0.0.0.0", "port": 8000}]}})";
}

struct Case {
  std::string json;
  std::string sentence;
};

const Case kValues[] = {
    {scoring(R"("10.100.1.200")", "99999"),
     "command_post.scoring.port: expected a whole number from 1 to 65535, got 99999"},
    {scoring(R"("10.100.1.200")", "0"),
     "command_post.scoring.port: expected a whole number from 1 to 65535, got 0"},
    {scoring(R"("10.100.1.200")", "-1"),
     "command_post.scoring.port: expected a whole number from 1 to 65535, got -1"},
    {scoring(R"("10.100.1.200")", "80.5"),
     "command_post.scoring.port: expected a whole number from 1 to 65535, got 80.5"},
    {scoring(R"("10.100.1.200")", R"("8000")"),
     "command_post.scoring.port: expected a whole number from 1 to 65535, got \"8000\""},
    {scoring(R"("10.100.1")", "8000"),
     "command_post.scoring.address: expected an IPv4 or IPv6 address, got \"10.100.1\""},
    {scoring(R"("10.100.1.200\u0000x")", "8000"),
     "command_post.scoring.address: expected an IPv4 or IPv6 address, got \"10.100.1.200\\u0000x\""},
    {scoring(R"("scoring.example")", "8000"),
     "command_post.scoring.address: expected an IPv4 or IPv6 address, got \"scoring.example\""},
    {scoring("null", "8000"), "command_post.scoring.address: expected an IPv4 or IPv6 address, got null"},
    {sample(R"(, "budget_mbit": 0)"),
     "command_post.budget_mbit: expected a number from 0.1 to 100000, got 0"},
    {sample(R"(, "rates": {"map_hz": 0})"),
     "command_post.rates.map_hz: expected a number from 0.001 to 1000, got 0"},
    {sample(R"(, "rates": {"map_hz": [1]})"),
     "command_post.rates.map_hz: expected a number from 0.001 to 1000, got an array"},
    {sample(R"(, "rates": 1)"), "command_post.rates: expected an object, got 1"},
    {sample(R"(, "interface": "sixteen_letters_")"),
     "command_post.interface: expected an interface's name of at most 15 characters, or \"\", got "
     "\"sixteen_letters_\""},
    {sample(R"(, "interface": "../x")"),
     "command_post.interface: expected an interface's name of at most 15 characters, or \"\", got "
     "\"../x\""},
    {sample("", "", R"(, "reports": {"review": "Off"})"),
     "reports.review: expected \"off\", \"duplicates\" or \"all\", got \"Off\""},
    {sample("", "", R"(, "reports": {"review": true})"),
     "reports.review: expected \"off\", \"duplicates\" or \"all\", got true"},
    {sample("", R"(, "require_token": "no")"), "team.require_token: expected true or false, got \"no\""},
    {sample("", R"(, "origins": "null")"),
     "team.origins: expected origins as browsers write them (http://10.0.0.20:3000) with spaces between "
     "them, or "
     "\"\", got \"null\""},
    {sample("", "", R"(, "panel": {"chip": "gpiochip0", "health": "a line"})"),
     "panel.health: expected a GPIO line's name of at most 31 characters, or \"\", got \"a line\""},
    {sample("", "", R"(, "panel": {"button": 3})"),
     "panel.button: expected a GPIO line's name of at most 31 characters, or \"\", got 3"},
    {sample("", "", R"(, "panel": {"button_active_low": "yes"})"),
     "panel.button_active_low: expected true or false, got \"yes\""}};

const Case kKeys[] = {
    {sample(R"(, "intrface": "darpa0")"),
     "command_post.intrface: no such key; did you mean interface? (keys here: scoring, mapping, "
     "interface, budget_mbit, rates, timeouts, arrange_clouds, course)"},
    {sample(R"(, "timeouts": {"connect": 5})"),
     "command_post.timeouts.connect: no such key; did you mean connect_ms? (keys here: connect_ms, "
     "scoring_answer_ms, mapping_answer_ms)"},
    {sample("", "", R"(, "rules": {"zzz": 1})"),
     "rules.zzz: no such key (keys here: rewrite_frame_id, forward_unknown_types, map_bytes)"},
    {sample("", "", R"(, "rules": {"a\u001b[2Jb": 1})"),
     "rules.\"a\\u001b[2Jb\": no such key (keys here: rewrite_frame_id, forward_unknown_types, "
     "map_bytes)"},
    {sample("", R"(, "connections": 1, "connections": 2)"), "team.connections: given twice"},
    {sample("", R"(, "listen": [{"address": "::", "port": 1}])"), "team.listen: given twice"}};

const Case kContradictions[] = {
    {sample("", "", R"(, "panel": {"chip": "gpiochip0"})"),
     "panel.chip: names a chip, but neither a light nor the button has a line"},
    {sample("", "", R"(, "panel": {"chip": "gpiochip0", "health": "H", "mapping": "H"})"),
     "panel.mapping: the same line as panel.health"},
    {sample("", "", R"(, "panel": {"attention": "H", "button": "H"})"),
     "panel.button: the same line as panel.attention"}};

const char* const kCourse =
    R"({"name": "A", "scoring": {"address": "::2", "port": 1}, "mapping": {"address": "::2", "port": 2}})";

const Case kNames[] = {
    {sample("", "", R"(, "robots": [{"name": "ugv-1"}])"),
     "robots[0].name: expected 1 to 10 letters, digits and underscores, got \"ugv-1\""},
    {sample("", "", R"(, "robots": [{"name": "ugv1"}, {"name": ""}])"),
     "robots[1].name: expected 1 to 10 letters, digits and underscores, got \"\""},
    {sample("", "", R"(, "robots": [{"name": "elevenlongs"}])"),
     "robots[0].name: expected 1 to 10 letters, digits and underscores, got \"elevenlongs\""},
    {sample("", "", R"(, "robots": [{"alias": "husky"}])"),
     "robots[0].name: missing; expected 1 to 10 letters, digits and underscores"},
    {sample("", "", R"(, "robots": [{"name": "ugv1", "alias": "a b"}])"),
     "robots[0].alias: expected at most 64 visible ASCII characters, or \"\", got \"a b\""},
    {sample("", "", R"(, "robots": {"name": "ugv1"})"),
     "robots: expected a list of at most 32 items, got an object"},
    {sample("", "", R"(, "robots": [{"name": "ugv1"}, {"name": "ugv1"}])"),
     "robots[1].name: the same as robots[0].name"},
    {sample("", "", R"(, "robots": [{"name": "ugv1", "alias": "x"}, {"name": "ugv2", "alias": "x"}])"),
     "robots[1].alias: the same as robots[0].alias"},
    {sample("", "", R"(, "robots": [{"name": "ugv1", "alias": "ugv2"}, {"name": "ugv2"}])"),
     "robots[0].alias: the same as robots[1].name; an alias is another name"},
    {sample("", "", R"(, "robots": [{"name": "ugv1", "alias": "ugv1"}])"),
     "robots[0].alias: the same as robots[0].name; an alias is another name"},
    {sample(R"(, "course": "A")"), "command_post.course: no course is called A; no courses are set up"},
    {sample(R"(, "course": "B")", "", std::string(R"(, "courses": [)") + kCourse + "]"),
     "command_post.course: no course is called B; the courses are A"},
    {sample(R"(, "course": "a/b")"), "command_post.course: expected a course's name, or \"\", got \"a/b\""},
    {sample("", "", std::string(R"(, "courses": [)") + kCourse + "," + kCourse + "]"),
     "courses[1].name: the same as courses[0].name"},
    {sample(
         "", "",
         R"(, "courses": [{"name": "..", "scoring": {"address": "::2", "port": 1}, "mapping": {"address": "::2", "port": 2}}])"),
     "courses[0].name: expected 1 to 20 letters, digits, underscores and hyphens, got \"..\""},
    {sample(
         "", "",
         R"(, "courses": [{"name": "A", "scoring": {"address": "0.0.0.0", "port": 8000}, "mapping": {"address": "::2", "port": 2}}])"),
     "team.listen[0]: the same as an endpoint of the Command Post, so that Adit would post to itself"},
    {sample(
         "", "",
         R"(, "courses": [{"name": "A", "scoring": {"address": "127.0.0.1", "port": 8000}, "mapping": {"address": "::2", "port": 2}}])"),
     "team.listen[0]: the same as an endpoint of the Command Post, so that Adit would post to itself"},
    {sample(
         "", "",
         R"(, "courses": [{"name": "A", "scoring": {"address": "224.0.0.1", "port": 1}, "mapping": {"address": "::2", "port": 2}}])"),
     "courses[0].scoring.address: 224.0.0.1 is no address of one machine"},
    {sample(
         "", "",
         R"(, "courses": [{"name": "A", "scoring": {"address": "::1", "port": 1}, "mapping": {"address": "::ffff:10.0.0.1", "port": 2}}])"),
     "courses[0].mapping.address: ::ffff:10.0.0.1 is an IPv4 address: write it in the form 10.0.0.1"},
    {sample("", "", R"(, "clock": {"ntp_server": "ntp.example.org"})"),
     R"(clock.ntp_server: expected an IPv4 address, or "", got "ntp.example.org")"},
    {sample("", "", R"(, "clock": {"ntp_server": "127.0.0.1"})"),
     "clock.ntp_server: 127.0.0.1 is no address of another machine"}};

void expect(std::span<const Case> cases) {
  for (const Case& row : cases) EXPECT_THAT(errors_of(row.json), ElementsAre(row.sentence));
}

TEST(SettingsErrors, NameKeyExpectedAndActualValue) {
  expect(kValues);
}
TEST(SettingsErrors, NameUnknownAndRepeatedKeys) {
  expect(kKeys);
}
TEST(SettingsErrors, NameContradictions) {
  expect(kContradictions);
}

TEST(SettingsErrors, NameInvalidAndAmbiguousRobotsAndCourses) {
  expect(kNames);
}

TEST(SettingsErrors, AreReportedAtOnceInTheOrderOfTheFile) {
  EXPECT_THAT(errors_of(R"({
      "version": 1,
      "panel": {"active_low": 1},
      "team": {"listen": [{"address": "here", "port": 8000}, {"address": "::", "prt": 8000}]},
      "command_post": {"scoring": {"port": 0}}})"),
              ElementsAre("panel.active_low: expected true or false, got 1",
                          "team.listen[0].address: expected an IPv4 or IPv6 address, got \"here\"",
                          "team.listen[1].prt: no such key; did you mean port? (keys here: address, port)",
                          "team.listen[1].port: missing; expected 0 to 65535",
                          "command_post.scoring.port: expected a whole number from 1 to 65535, got 0",
                          "command_post.scoring.address: missing; expected an IPv4 or IPv6 address",
                          "command_post.mapping.address: missing; expected an IPv4 or IPv6 address",
                          "command_post.mapping.port: missing; expected 1 to 65535"));
}

TEST(SettingsErrors, NameEachRequiredKeyOfAnEmptyFile) {
  EXPECT_THAT(errors_of("{}"),
              ElementsAre("version: missing; expected 1", HasSubstr("command_post.scoring.address"),
                          HasSubstr("command_post.scoring.port"), HasSubstr("command_post.mapping.address"),
                          HasSubstr("command_post.mapping.port"), HasSubstr("team.listen")));
}

TEST(SettingsErrors, OfAnotherVersionNameOnlyTheVersion) {
  EXPECT_THAT(errors_of(R"({"version": 2, "profiles": []})"), ElementsAre("version: expected 1, got 2"));
  EXPECT_THAT(errors_of(R"({"profiles": [], "version": "1"})"),
              ElementsAre("version: expected 1, got \"1\""));
}

TEST(SettingsErrors, WithoutAVersionNameAllFaults) {
  EXPECT_THAT(errors_of(R"({"profiles": []})"), SizeIs(testing::Gt(2)));
}

TEST(SettingsErrors, OfInvalidJsonNameTheByte) {
  for (const std::string json : {"", "{", "{\"version\": 01}", "{} x", "{\"version\": 1,}"}) {
    EXPECT_THAT(errors_of(json), ElementsAre(HasSubstr("not well-formed JSON at byte "))) << json;
  }
  EXPECT_THAT(errors_of("[]"), ElementsAre("expected an object, got an array"));
}

TEST(SettingsErrors, RejectEmptyAndTooLongLists) {
  const std::string before = R"({"version": 1, "command_post": {"scoring": {"address": "::1", "port": 1},)"
                             R"("mapping": {"address": "::1", "port": 2}}, "team": {"listen": )";
  EXPECT_THAT(errors_of(before + "[]}}"),
              ElementsAre("team.listen: expected a list of 1 to 16 items, got 0"));
  EXPECT_THAT(errors_of(before + "{}}}"),
              ElementsAre("team.listen: expected a list of 1 to 16 items, got an object"));
  std::string items = R"([{"address": "::2", "port": 0})";
  for (int i = 0; i < 16; ++i) items += R"(, {"address": "::2", "port": 0})";
  EXPECT_THAT(errors_of(before + items + "]}}"),
              ElementsAre("team.listen: expected a list of 1 to 16 items, got 17"));
}

TEST(SettingsErrors, RejectListeningTwiceAtOneAddress) {
  const std::string before = R"({"version": 1, "command_post": {"scoring": {"address": "::1", "port": 1},)"
                             R"("mapping": {"address": "::1", "port": 2}}, "team": {"listen": )";
  EXPECT_THAT(errors_of(before + R"([{"address": "::2", "port": 9}, {"address": "::2", "port": 9}]}})"),
              ElementsAre("team.listen[1]: the same as team.listen[0]"));
  EXPECT_THAT(errors_of(before + R"([{"address": "::1", "port": 2}]}})"),
              ElementsAre(HasSubstr("team.listen[0]: the same as an endpoint of the Command Post")));
}

TEST(SettingsErrors, ShowAtMostALineOfAValue) {
  const auto errors = errors_of(sample(R"(, "interface": ")" + std::string(100000, 'x') + "\""));
  ASSERT_THAT(errors, SizeIs(1));
  EXPECT_THAT(errors[0], AllOf(HasSubstr("xxx..."), SizeIs(testing::Lt(200))));
}

}  // namespace
}  // namespace adit::settings
