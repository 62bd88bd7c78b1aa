#include "api/settings_routes.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "api/on_page.hpp"

namespace adit::api {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using Status = icd::Status;

class SettingsRoutesTest : public OnPage {
 protected:
  intake::Answer post(const std::string& path, const json& body) { return Page::post(path, body.dump()); }
  json shown() { return json::parse(get("/adit/settings").body); }
};

TEST_F(SettingsRoutesTest, ShowAllSettingsButNoToken) {
  const json stored = shown();
  EXPECT_EQ(stored["settings"], json::parse(settings::file_of(setup.now)));
  EXPECT_EQ(stored["tag"], settings::tag_of(setup.now));
  EXPECT_EQ(stored["saved"], false);
  EXPECT_EQ(stored["tokens"], (json{{"scoring", true}, {"course.A.mapping", false}}));
  EXPECT_EQ(stored["odd_tokens"], (json{{{"path", "scoring"}, {"what", "odd"}}}));
  const auto key = [&](const std::string& path) {
    for (const json& row : stored["keys"]) {
      if (row["path"] == path) return row;
    }
    return json();
  };
  EXPECT_EQ(key("team.connections"), (json{{"path", "team.connections"},
                                           {"meaning",
                                            "Connections of the team at once, at most. Unauthenticated "
                                            "clients get a quarter of them, at most 32."},
                                           {"kind", "whole"},
                                           {"required", false},
                                           {"default", 128},
                                           {"range", "1 to 1024"},
                                           {"least", 1},
                                           {"most", 1024}}));
  EXPECT_EQ(key("reports.review")["words"], (json{"off", "duplicates", "all"}));
  EXPECT_EQ(key("command_post.scoring.address")["default"], nullptr);
  EXPECT_EQ(key("command_post.budget_mbit")["kind"], "real");
}

TEST_F(SettingsRoutesTest, ExportTheFileForADownload) {
  const auto answer = get("/adit/settings/export");
  EXPECT_EQ(answer.body, settings::file_of(setup.now));
  EXPECT_EQ(header(answer, "Content-Disposition"), "attachment; filename=\"adit-settings.json\"");
}

TEST_F(SettingsRoutesTest, TellThatAChangeIsBeingApplied) {
  EXPECT_EQ(shown()["applying"], false);
  EXPECT_EQ(post("/adit/course", {{"name", "A"}}).status, Status::Ok);
  EXPECT_EQ(shown()["applying"], true);
}

TEST_F(SettingsRoutesTest, TellWhyTheLastChangeWasReverted) {
  EXPECT_EQ(shown()["trouble"], "");
  setup.why = "the last change was reverted: no such interface";
  EXPECT_EQ(shown()["trouble"], setup.why);
}

TEST_F(SettingsRoutesTest, SendRetryAfterOnlyWhileAChangeIsApplied) {
  json stored = shown();
  const json change = {{"settings", stored["settings"]}, {"base", stored["tag"]}};
  const json stale = {{"settings", stored["settings"]}, {"base", "another"}};
  setup.refusal = icd::Refusal{Status::Conflict, "whatever the sentence is"};
  for (const auto& answer : {post("/adit/settings", change), post("/adit/course", {{"name", "A"}}),
                             post("/adit/tokens", {{"name", "scoring"}, {"token", nullptr}}),
                             post("/adit/reset", {{"password", "correct horse"}})}) {
    EXPECT_EQ(answer.status, Status::Conflict);
    EXPECT_THAT(answer.headers, testing::Contains(testing::FieldsAre("Retry-After", "1")));
  }
  const auto answer = post("/adit/settings", stale);
  EXPECT_EQ(answer.status, Status::Conflict);
  EXPECT_THAT(answer.headers, testing::Not(testing::Contains(testing::FieldsAre("Retry-After", "1"))));
}

TEST_F(SettingsRoutesTest, PassOnUnchangedSettings) {
  setup.refusal = icd::Refusal{Status::Conflict, "another change is being applied: try again"};
  EXPECT_EQ(post("/adit/course", {{"name", ""}}).status, Status::Conflict);
}

TEST_F(SettingsRoutesTest, CheckWithoutChangingAnything) {
  json settings = shown()["settings"];
  settings["team"]["require_token"] = false;
  EXPECT_EQ(json::parse(post("/adit/settings/check", {{"settings", settings}}).body),
            (json{{"errors", json::array()},
                  {"changes", {{{"path", "team.require_token"}, {"from", true}, {"to", false}}}},
                  {"warnings", {"no token is asked for"}}}));
  settings["team"]["connections"] = 0;
  settings["team"]["conections"] = 1;
  const json wrong = json::parse(post("/adit/settings/check", {{"settings", settings}}).body);
  EXPECT_EQ(wrong["errors"].size(), 2u);
  EXPECT_EQ(wrong["errors"][0]["path"], "team.conections");
  EXPECT_EQ(wrong["errors"][1],
            (json{{"path", "team.connections"}, {"what", "expected a whole number from 1 to 1024, got 0"}}));
  EXPECT_EQ(wrong["changes"], json::array());
  EXPECT_EQ(setup.saves, 0);
}

TEST_F(SettingsRoutesTest, SaveGoodSettingsAndListTheChanges) {
  json stored = shown();
  stored["settings"]["team"]["connections"] = 65;
  const auto answer = post("/adit/settings", {{"settings", stored["settings"]}, {"base", stored["tag"]}});
  EXPECT_EQ(answer.status, Status::Ok);
  EXPECT_EQ(json::parse(answer.body),
            (json{{"changes", {{{"path", "team.connections"}, {"from", 128}, {"to", 65}}}},
                  {"warnings", json::array()}}));
  EXPECT_EQ(setup.now.team.connections, 65u);
  EXPECT_EQ(post("/adit/settings", {{"settings", stored["settings"]}, {"base", stored["tag"]}}).status,
            Status::Conflict)
      << "the change is based on older settings";
  setup.is_applying = false;
  stored["tag"] = shown()["tag"];
  EXPECT_EQ(
      json::parse(post("/adit/settings", {{"settings", stored["settings"]}, {"base", stored["tag"]}}).body),
      (json{{"changes", json::array()}, {"warnings", json::array()}}));
}

TEST_F(SettingsRoutesTest, RejectPortZero) {
  json stored = shown();
  stored["settings"]["team"]["listen"].push_back({{"address", "10.0.0.1"}, {"port", 0}});
  const auto checked = post("/adit/settings/check", {{"settings", stored["settings"]}});
  EXPECT_THAT(checked.body, HasSubstr("].port"));
  EXPECT_THAT(checked.body, HasSubstr("expected 1 to 65535, got 0"));
  const auto saved = post("/adit/settings", {{"settings", stored["settings"]}, {"base", stored["tag"]}});
  EXPECT_EQ(saved.status, Status::UnprocessableEntity);
  EXPECT_EQ(setup.saves, 0);
}

TEST_F(SettingsRoutesTest, RejectBadSettingsWithAllErrors) {
  const json stored = shown();
  json settings = stored["settings"];
  settings["team"]["connections"] = "many";
  settings["robots"] = {{{"name", "ugv-1"}}};
  const auto answer = post("/adit/settings", {{"settings", settings}, {"base", stored["tag"]}});
  EXPECT_EQ(answer.status, Status::UnprocessableEntity);
  EXPECT_THAT(std::string(json::parse(answer.body)),
              HasSubstr("team.connections: expected a whole number from "));
  EXPECT_THAT(std::string(json::parse(answer.body)), HasSubstr("; "));
  EXPECT_THAT(std::string(json::parse(answer.body)), HasSubstr("robots[0].name: expected 1 to 10 letters"));
  EXPECT_EQ(setup.saves, 0);
}

TEST_F(SettingsRoutesTest, RejectMalformedBodiesWithTheFieldsName) {
  const json good = shown()["settings"];
  const struct {
    const char* path;
    json body;
    const char* word;
  } rows[] = {
      {"/adit/settings", {{"settings", good}}, "base: missing"},
      {"/adit/settings", {{"settings", good}, {"base", 7}}, "base: expected a string"},
      {"/adit/settings", {{"base", "x"}}, "settings: missing"},
      {"/adit/settings", {{"settings", "x"}, {"base", "x"}}, "settings: expected an object"},
      {"/adit/settings/check", json::object(), "settings: missing"},
      {"/adit/settings/check", {{"settings", json::array()}}, "settings: expected an object"},
      {"/adit/settings/check", json::array(), "expected an object"},
      {"/adit/tokens", json::object(), "name, token: missing"},
      {"/adit/tokens", {{"name", "scoring"}}, "token: missing"},
      {"/adit/tokens", {{"name", "scoring"}, {"token", 5}}, "token: expected a string"},
      {"/adit/tokens", {{"name", "scoring"}, {"token", ""}}, "token: expected null or 1 to 256 visible"},
      {"/adit/tokens", {{"name", "scoring"}, {"token", "two words"}}, "token: expected null or 1 to 256"},
      {"/adit/tokens", {{"name", "scoring"}, {"token", std::string(257, 'x')}}, "token: expected null or"},
      {"/adit/tokens", {{"name", "team"}, {"token", "1234567"}}, "token: expected at least 8 characters"},
      {"/adit/tokens",
       {{"name", "../x"}, {"token", "x"}},
       "name: expected one of scoring, course.A.mapping, got"},
      {"/adit/course", json::object(), "name: missing"},
      {"/adit/course", {{"name", nullptr}}, "name: expected a string"},
      {"/adit/course", {{"name", "B"}}, "command_post.course: no course is called B; the courses are A"}};
  for (const auto& row : rows) {
    const auto answer = post(row.path, row.body);
    EXPECT_EQ(answer.status, Status::UnprocessableEntity) << row.path << row.body;
    EXPECT_THAT(answer.body, HasSubstr(row.word)) << row.path << row.body;
    EXPECT_THAT(answer.body, Not(HasSubstr("two words"))) << "the answer repeats a rejected token";
  }
  EXPECT_EQ(request("POST", "/adit/course", {kByToken, {"Content-Type", "application/json"}}, "{").status,
            Status::BadRequest);
  EXPECT_EQ(request("POST", "/adit/course", {kByToken, {"Content-Type", "text/plain"}}, "{}").status,
            Status::UnprocessableEntity);
  EXPECT_EQ(post("/adit/settings", {{"settings", std::string(300000, 'x')}}).status, Status::ContentTooLarge);
  EXPECT_EQ(setup.saves, 0);
  EXPECT_TRUE(setup.set.empty());
}

TEST_F(SettingsRoutesTest, SetAndRemoveATokenWithoutShowingIt) {
  const auto answer = post("/adit/tokens", {{"name", "course.A.mapping"}, {"token", "rust871}backdoor"}});
  EXPECT_EQ(json::parse(answer.body), (json{{"name", "course.A.mapping"}, {"set", true}}));
  EXPECT_EQ(json::parse(post("/adit/tokens", {{"name", "scoring"}, {"token", nullptr}}).body),
            (json{{"name", "scoring"}, {"set", false}}));
  EXPECT_THAT(setup.set, ElementsAre(std::pair("course.A.mapping", "rust871}backdoor"),
                                     std::pair("scoring", "removed")));
}

TEST_F(SettingsRoutesTest, SwitchTheCourseByNameAndBackToNone) {
  EXPECT_EQ(json::parse(post("/adit/course", {{"name", "A"}}).body),
            (json{{"changes", {{{"path", "command_post.course"}, {"from", ""}, {"to", "A"}}}},
                  {"warnings", {"reports go elsewhere"}}}));
  EXPECT_EQ(setup.now.command_post.course, "A");
  EXPECT_EQ(post("/adit/course", {{"name", ""}}).status, Status::Ok);
  EXPECT_EQ(setup.now.command_post.course, "");
}

TEST_F(SettingsRoutesTest, ResetOnlyWithTheOperatorsPassword) {
  EXPECT_EQ(post("/adit/reset", {{"password", "look, do not touch"}}).status, Status::Forbidden)
      << "for a viewer";
  EXPECT_EQ(post("/adit/reset", json::object()).status, Status::UnprocessableEntity);
  EXPECT_EQ(setup.resets, 0);
  const auto answer = post("/adit/reset", {{"password", "correct horse"}});
  EXPECT_EQ(answer.status, Status::Ok);
  EXPECT_THAT(answer.body, HasSubstr("the reports are kept"));
  EXPECT_THAT(header(answer, "Set-Cookie"), HasSubstr("Max-Age=0"));
  EXPECT_EQ(setup.resets, 1);
}

TEST_F(SettingsRoutesTest, LimitGuessesOfThePasswordByReset) {
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(post("/adit/reset", {{"password", "guess"}}).status, Status::Forbidden);
  }
  EXPECT_EQ(post("/adit/reset", {{"password", "correct horse"}}).status, Status::TooManyRequests);
  EXPECT_EQ(setup.resets, 0);
}

TEST_F(SettingsRoutesTest, TellWhyAChangeFails) {
  setup.refusal = {Status::ServiceUnavailable, "cannot store the change: No space left on device"};
  json stored = shown();
  stored["settings"]["team"]["connections"] = 65;
  for (const auto& answer :
       {post("/adit/settings", {{"settings", stored["settings"]}, {"base", stored["tag"]}}),
        post("/adit/tokens", {{"name", "scoring"}, {"token", "x"}}), post("/adit/course", {{"name", "A"}}),
        post("/adit/reset", {{"password", "correct horse"}})}) {
    EXPECT_EQ(answer.status, Status::ServiceUnavailable);
    EXPECT_EQ(json::parse(answer.body), setup.refusal->sentence);
  }
}

}  // namespace
}  // namespace adit::api
