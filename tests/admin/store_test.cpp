#include "admin/store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "host/folder.hpp"
#include "host/log.hpp"
#include "settings/sample.hpp"

namespace adit::admin {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kCourse =
    R"(, "courses": [{"name": "A", "scoring": {"address": "10.100.2.200", "port": 8000},)"
    R"( "mapping": {"address": "10.100.2.201", "port": 8000}}])";

class StoreTest : public testing::Test {
 protected:
  StoreTest() {
    given_.put("settings.json", settings::sample("", R"(, "connections": 20)"));
    given_.put("scoring.token", "given-1");
  }
  static settings::Settings with_connections(std::uint32_t connections) {
    auto settings = settings::parse(settings::sample("", "", kCourse)).value();
    settings.team.connections = connections;
    return settings;
  }
  std::uint32_t connections() { return store_.load().value().settings.team.connections; }
  bool kept(const std::string& name) const { return std::filesystem::exists(state_ / name); }

  host::Folder given_, state_;
  Store store_{given_ / "settings.json", given_.path(), state_.path()};
};

TEST_F(StoreTest, LoadsGivenSettingsUntilOthersAreSaved) {
  const auto given = store_.load().value();
  EXPECT_FALSE(given.saved);
  EXPECT_EQ(given.settings.team.connections, 20u);
  EXPECT_EQ(given.secrets.token("scoring")->reveal(), "given-1");
  ASSERT_TRUE(store_.save(with_connections(30)).has_value());
  const auto saved = store_.load().value();
  EXPECT_TRUE(saved.saved);
  EXPECT_EQ(saved.settings.team.connections, 30u);
  EXPECT_EQ(saved.trouble, "");
}

TEST_F(StoreTest, RevertsToTheLastSettledSettings) {
  EXPECT_FALSE(store_.revert()) << "no settings are on trial";
  (void)store_.save(with_connections(30));
  store_.settle(with_connections(30));
  EXPECT_FALSE(store_.revert());
  (void)store_.save(with_connections(40));
  (void)store_.save(with_connections(50));
  EXPECT_TRUE(store_.revert());
  EXPECT_EQ(connections(), 30u) << "the last settings that worked";
  EXPECT_FALSE(store_.revert());
}

TEST_F(StoreTest, RevertsTheFirstSaveToGivenSettings) {
  (void)store_.save(with_connections(30));
  EXPECT_TRUE(store_.revert());
  EXPECT_FALSE(store_.load().value().saved);
  EXPECT_EQ(connections(), 20u);
}

TEST_F(StoreTest, ReportsEmptyPreviousSettingsAsDamaged) {
  (void)store_.save(with_connections(30));
  store_.settle(with_connections(30));
  (void)store_.save(with_connections(40));
  state_.put("settings.json.before", "");
  EXPECT_TRUE(store_.revert());
  EXPECT_THAT(store_.load()->trouble, HasSubstr("the saved settings were set aside"));
}

TEST_F(StoreTest, RenamesInvalidSavedSettings) {
  state_.put("settings.json", R"({"version": 1, "team": 7})");
  const auto loaded = store_.load().value();
  EXPECT_FALSE(loaded.saved);
  EXPECT_EQ(loaded.settings.team.connections, 20u);
  EXPECT_THAT(loaded.trouble, HasSubstr("team: expected an object, got 7"));
  EXPECT_TRUE(kept("settings.json.damaged"));
  EXPECT_EQ(store_.load().value().trouble, "");
}

TEST_F(StoreTest, IgnoresUnknownSettingsOfALaterAdit) {
  ASSERT_TRUE(store_.save(with_connections(30)));
  std::string text = host::read_file(state_ / "settings.json").value();
  text.insert(text.find('{') + 1, R"("beacons": {"port": 7}, )");
  const std::string team = R"("team":)";
  ASSERT_NE(text.find(team), std::string::npos) << text;
  text.insert(text.find('{', text.find(team)) + 1, R"("mesh": [1, 2], )");
  state_.put("settings.json", text);
  const auto loaded = store_.load().value();
  EXPECT_TRUE(loaded.saved);
  EXPECT_EQ(loaded.settings.team.connections, 30u);
  EXPECT_EQ(loaded.trouble, "a later Adit saved the settings; these settings are ignored: beacons team.mesh");
  EXPECT_EQ(host::read_file(state_ / "settings.json"), text) << "a later version's file must not change";
}

TEST_F(StoreTest, LogsAnEarlierVersionsSettingWithoutEffectUntilTheNextSave) {
  const std::string old = settings::sample("", "", R"(, "robots": [{"name": "ugv1", "voxel_metres": 0.1}])");
  given_.put("settings.json", old);
  for (int saved = 0; saved < 2; ++saved) {
    const std::uint64_t before = host::last_record_number();
    const auto loaded = store_.load().value();
    EXPECT_EQ(loaded.trouble, "");
    ASSERT_EQ(loaded.settings.robots.size(), 1u);
    const auto records = host::records_after(before);
    ASSERT_EQ(records.size(), 1u);
    EXPECT_EQ(records[0].level, host::Level::Notice);
    EXPECT_EQ(records[0].message, "the setting has no effect any more");
    EXPECT_THAT(records[0].fields, ElementsAre(testing::Pair("setting", "robots[0].voxel_metres")));
    state_.put("settings.json", old);
  }
  ASSERT_TRUE(store_.save(store_.load()->settings).has_value());
  const std::uint64_t before = host::last_record_number();
  EXPECT_EQ(store_.load()->settings.robots.size(), 1u);
  EXPECT_EQ(host::last_record_number(), before);
}

TEST_F(StoreTest, TellsWhyNoSettingsCanBeUsed) {
  std::filesystem::remove(given_ / "settings.json");
  EXPECT_EQ(store_.load().error(), (given_ / "settings.json") + ": No such file or directory");
}

TEST_F(StoreTest, PrefersSavedTokensReadableByAditdOnly) {
  ASSERT_TRUE(store_.save_token("scoring", icd::BearerToken::parse("saved-1")).has_value());
  EXPECT_EQ(store_.load()->secrets.token("scoring")->reveal(), "saved-1");
  struct stat status{};
  ASSERT_EQ(stat((state_ / "secrets").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0700u);
  ASSERT_EQ(stat((state_ / "secrets/scoring.token").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0600u);
  ASSERT_TRUE(store_.save_token("scoring", std::nullopt).has_value());
  EXPECT_EQ(store_.load()->secrets.token("scoring")->reveal(), "given-1");
  EXPECT_TRUE(store_.save_token("scoring", std::nullopt).has_value()) << "removing an absent token succeeds";
}

TEST_F(StoreTest, LoadsTheTokensOfEachCourse) {
  EXPECT_THAT(token_names(with_connections(30)),
              ElementsAre("scoring", "mapping", "team", "course.A.scoring", "course.A.mapping"));
  (void)store_.save(with_connections(30));
  (void)store_.save_token("course.A.mapping", icd::BearerToken::parse("of-a"));
  EXPECT_EQ(store_.load()->secrets.token("course.A.mapping")->reveal(), "of-a");
}

TEST_F(StoreTest, SettlingDeletesTokensOfRemovedCourses) {
  (void)store_.save_token("course.A.mapping", icd::BearerToken::parse("of-a"));
  (void)store_.save_token("course.B.mapping", icd::BearerToken::parse("of-b"));
  (void)store_.save_token("team", icd::BearerToken::parse("team-1"));
  (void)store_.save(with_connections(30));
  EXPECT_TRUE(kept("secrets/course.B.mapping.token")) << "the settings may still be reverted";
  store_.settle(with_connections(30));
  EXPECT_FALSE(kept("secrets/course.B.mapping.token"));
  EXPECT_TRUE(kept("secrets/course.A.mapping.token") && kept("secrets/team.token"));
}

TEST_F(StoreTest, UnreadableFilesAreKeptAndPreventARevert) {
  (void)store_.save(with_connections(30));
  store_.settle(with_connections(30));
  (void)store_.save(with_connections(40));
  (void)store_.save_token("course.A.mapping", icd::BearerToken::parse("of-a"));
  for (const char* const name : {"settings.json", "secrets/scoring.token", "secrets/team.token"}) {
    const bool was_there = kept(name);
    if (was_there) std::filesystem::rename(state_ / name, state_ / "elsewhere");
    std::filesystem::create_directory(state_ / name);
    const auto loaded = store_.load();
    ASSERT_TRUE(loaded.has_value()) << loaded.error();
    EXPECT_EQ(store_.unread(), (state_ / name) + ": is not a regular file");
    EXPECT_EQ(store_.save(loaded->settings).error(), store_.unread())
        << "default settings must not be saved over unreadable ones";
    store_.settle(loaded->settings);
    EXPECT_FALSE(store_.revert());
    EXPECT_TRUE(kept(name) && kept("settings.json.before") && kept("secrets/course.A.mapping.token")) << name;
    EXPECT_FALSE(kept("settings.json.damaged") || kept("secrets.damaged")) << name;
    EXPECT_FALSE(store_.can_be_read());
    std::filesystem::remove(state_ / name);
    if (was_there) std::filesystem::rename(state_ / "elsewhere", state_ / name);
    EXPECT_TRUE(store_.can_be_read());
    EXPECT_EQ(connections(), 40u);
    EXPECT_EQ(store_.unread(), "");
  }
  EXPECT_TRUE(store_.revert());
}

TEST_F(StoreTest, NamesDamagedTokensAndKeepsTheirFiles) {
  for (const char* const name : {"mapping", "scoring"}) {
    (void)store_.save_token(name, icd::BearerToken::parse("saved-1"));
    for (const char* const copy : {"", host::kCopy})
      state_.put("secrets/" + std::string(name) + ".token" + copy, "saved 1");
  }
  const auto trouble = store_.load().value().trouble;
  EXPECT_THAT(trouble, HasSubstr("the saved token mapping is damaged"));
  EXPECT_THAT(trouble, HasSubstr("; the saved token scoring is damaged"));
  EXPECT_TRUE(kept("secrets/scoring.token"));
}

TEST_F(StoreTest, UsesNoGivenTokenInsteadOfALostOne) {
  (void)store_.save_token("scoring", icd::BearerToken::parse("saved-1"));
  std::filesystem::remove_all(state_ / "secrets");
  for (int start = 0; start < 2; ++start) {
    const auto loaded = store_.load().value();
    EXPECT_FALSE(loaded.secrets.token("scoring"));
    EXPECT_THAT(loaded.trouble, HasSubstr("the saved token scoring is lost"));
    store_.settle(loaded.settings);
  }
  ASSERT_TRUE(store_.forget().has_value());
  EXPECT_EQ(store_.load()->secrets.token("scoring")->reveal(), "given-1");
  EXPECT_EQ(store_.load()->trouble, "");
}

TEST_F(StoreTest, StrikesReplacedTokensUntilAReset) {
  const auto struck = [this](std::string text) {
    store_.load()->secrets.redaction().strike_from(text);
    return text;
  };
  const auto save = [this](const char* token) {
    return store_.save_token("team", icd::BearerToken::parse(token)).has_value();
  };
  given_.put("team.token", "given-team-token");
  ASSERT_TRUE(save("saved-team-token") && save("saved-team-token") && save("third-team-token"));
  for (const char* const token : {"given-team-token", "saved-team-token", "third-team-token"})
    EXPECT_THAT(struck(token), Not(HasSubstr(token)));
  EXPECT_EQ(store_.load()->secrets.tokens.size(), 2u) << "scoring and team";
  ASSERT_TRUE(store_.save_token("team", std::nullopt).has_value());
  EXPECT_THAT(struck("third-team-token"), Not(HasSubstr("third")));
  struct stat status{};
  ASSERT_EQ(stat((state_ / "secrets/replaced").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0600u);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(save(("team-token-" + std::to_string(i)).c_str()));
  EXPECT_EQ(store_.load()->secrets.replaced.size(), 64u);
  ASSERT_TRUE(store_.forget().has_value());
  EXPECT_EQ(struck("third-team-token"), "third-team-token");
}

TEST_F(StoreTest, NamesLostSettings) {
  (void)store_.save(with_connections(30));
  store_.settle(with_connections(30));
  std::filesystem::remove(state_ / "settings.json");
  EXPECT_THAT(store_.load()->trouble, HasSubstr("the saved settings are lost"));
  EXPECT_EQ(connections(), 20u);
  (void)store_.save(with_connections(30));
  EXPECT_EQ(store_.load()->trouble, "");
}

TEST_F(StoreTest, UsesCopiesOfDamagedFiles) {
  (void)store_.save(with_connections(30));
  (void)store_.save_token("team", icd::BearerToken::parse("first-team-token"));
  (void)store_.save_token("team", icd::BearerToken::parse("next-team-token"));
  store_.settle(with_connections(30));
  for (const char* const file : {"settings.json", "secrets/team.token", "secrets/replaced"}) {
    std::filesystem::resize_file(state_ / file, 4);
    const auto loaded = store_.load().value();
    EXPECT_EQ(loaded.trouble, "") << file;
    EXPECT_EQ(loaded.settings.team.connections, 30u);
    EXPECT_EQ(loaded.secrets.token("team")->reveal(), "next-team-token");
    std::string text = "first-team-token";
    loaded.secrets.redaction().strike_from(text);
    EXPECT_NE(text, "first-team-token");
    store_.settle(with_connections(30));  // copies no damage
  }
  ASSERT_TRUE(store_.save_token("team", std::nullopt).has_value());
  EXPECT_FALSE(kept("secrets/team.token.copy"));
}

/// As adit-import does from a card.
TEST_F(StoreTest, NoticesTheLossOfFilesThatAnotherProgramSaved) {
  std::filesystem::create_directory(state_ / "secrets");
  state_.put("secrets/scoring.token", "saved-1");
  store_.settle(with_connections(30));
  state_.put("secrets/scoring.token", "");
  EXPECT_EQ(store_.load()->secrets.token("scoring")->reveal(), "saved-1");
  std::filesystem::remove(state_ / "secrets/scoring.token");
  EXPECT_FALSE(store_.load()->secrets.token("scoring"));
}

TEST_F(StoreTest, ReportsAWriteError) {
  Store nowhere(given_ / "settings.json", given_.path(), state_ / "none");
  EXPECT_THAT(nowhere.save(with_connections(30)).error(), HasSubstr("No such file or directory"));
}

TEST_F(StoreTest, ForgetDeletesOnlySavedFiles) {
  state_.put("ledger", "reports");
  (void)store_.save(with_connections(30));
  (void)store_.save_token("scoring", icd::BearerToken::parse("saved-1"));
  state_.put("settings.json.damaged", "what nobody could read");
  ASSERT_TRUE(store_.forget().has_value());
  for (const char* gone : {"settings.json", "settings.json.before", "settings.json.damaged",
                           "settings.json.saved", "scoring.token.saved", "secrets"})
    EXPECT_FALSE(kept(gone)) << gone;
  EXPECT_TRUE(kept("ledger"));
  EXPECT_EQ(connections(), 20u);
}

}  // namespace
}  // namespace adit::admin
