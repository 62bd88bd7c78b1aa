#include "admin/setup.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "host/folder.hpp"
#include "settings/sample.hpp"

namespace adit::admin {
namespace {

class SetupTest : public testing::Test {
 protected:
  /// Files that were copied to the box.
  struct Given : host::Folder {
    Given() { put("settings.json", settings::sample()); }
  };
  settings::Settings with_connections(std::uint32_t connections) const {
    settings::Settings next = setup_.settings();
    next.team.connections = connections;
    return next;
  }
  std::string saved_file() const { return state_ / settings::kSavedFile; }

  Given given_;
  host::Folder state_, runtime_;
  Store store_{given_ / "settings.json", given_.path(), state_.path()};
  FactoryReset reset_{store_, state_.path(), runtime_.path()};
  int applied_ = 0;
  admin::Setup setup_{store_,
                      reset_,
                      store_.load().value(),
                      "",
                      [](const std::string&) { return ""; },
                      [this] { ++applied_; },
                      [] {}};
};

TEST_F(SetupTest, AppliesNothingIfSettingsAreUnchanged) {
  EXPECT_TRUE(setup_.save(setup_.settings()).has_value());
  EXPECT_EQ(applied_, 0);
  EXPECT_FALSE(std::filesystem::exists(saved_file()));
}

TEST_F(SetupTest, RejectsASaveIfSavedSettingsCannotBeRead) {
  std::filesystem::create_directory(saved_file());
  setup_.set_running(store_.load().value(), "");
  const auto saved = setup_.save(setup_.settings());
  ASSERT_FALSE(saved) << "unreadable settings cannot be compared";
  EXPECT_EQ(saved.error().status, icd::Status::ServiceUnavailable);
}

TEST_F(SetupTest, RejectsASaveWhileAnotherIsApplied) {
  ASSERT_TRUE(setup_.save(with_connections(30)).has_value());
  EXPECT_EQ(setup_.save(setup_.settings()).error().status, icd::Status::Conflict);
}

TEST_F(SetupTest, TellsWhyTheLastChangeWasReverted) {
  EXPECT_EQ(setup_.trouble(), "");
  setup_.set_running(store_.load().value(), "the last change was reverted: no room");
  EXPECT_EQ(setup_.trouble(), "the last change was reverted: no room");
  setup_.set_running(store_.load().value(), "");
  EXPECT_EQ(setup_.trouble(), "");
}

TEST_F(SetupTest, WarnsIfPagesMayPostWithoutAToken) {
  settings::Settings next = setup_.settings();
  next.team.origins = "http://10.0.0.20:3000";
  EXPECT_THAT(setup_.warnings(next), testing::IsEmpty()) << "every course needs a token";
  next.team.require_token = false;
  EXPECT_THAT(setup_.warnings(next),
              testing::ElementsAre(testing::HasSubstr("every machine on the team's network"),
                                   testing::HasSubstr("pages of http://10.0.0.20:3000 may post reports")));
}

TEST_F(SetupTest, WarnsOfATokenOfUnusualLength) {  // ICD 4
  ASSERT_TRUE(store_.save_token("scoring", icd::BearerToken::parse("flux230{showroom")));
  ASSERT_TRUE(store_.save_token("mapping", icd::BearerToken::parse("flux230{showroo")));
  ASSERT_TRUE(store_.save_token("team", icd::BearerToken::parse("the-teams-own-token")));
  setup_.set_running(store_.load().value(), "");
  for (const api::TokenRow& row : setup_.tokens()) {
    EXPECT_TRUE(row.set) << row.name;
    EXPECT_EQ(row.warning, row.name == "mapping" ? "the token mapping has 15 characters; the Command Post's "
                                                   "tokens have 16 (ICD 4); is it complete?"
                                                 : "");
  }
}

// A failed save may leave its settings on the disk. A save of the current settings then writes them,
// because the next start would otherwise use the others.
TEST_F(SetupTest, SavesCurrentSettingsAfterAFailedSave) {
  std::filesystem::create_directories(saved_file() + "/in the way");
  EXPECT_EQ(setup_.save(with_connections(30)).error().status, icd::Status::ServiceUnavailable);
  std::filesystem::remove_all(saved_file());
  ASSERT_TRUE(setup_.save(setup_.settings()).has_value());
  EXPECT_EQ(applied_, 1);
  EXPECT_TRUE(std::filesystem::exists(saved_file()));
}

}  // namespace
}  // namespace adit::admin
