#include "settings/written.hpp"

#include <gmock/gmock.h>

#include "codec/json.hpp"
#include "settings/keys.hpp"
#include "settings/sample.hpp"

namespace adit::settings {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const char* const kTeamOfTwo =
    R"(, "robots": [{"name": "ugv1"}, {"name": "ugv2", "alias": "husky-2"}], "courses": [)"
    R"({"name": "A", "scoring": {"address": "10.100.1.200", "port": 8000},)"
    R"( "mapping": {"address": "10.100.1.201", "port": 8000}}])";

Settings settings_of(const std::string& json) {
  return parse(json).value();
}

std::vector<std::string> sentences(const std::vector<Change>& changes) {
  std::vector<std::string> all;
  all.reserve(changes.size());
  for (const Change& change : changes) {
    all.push_back(change.path + ": " + codec::write_json(change.from) + " -> " +
                  codec::write_json(change.to));
  }
  return all;
}

TEST(WrittenSettings, ReadBackTheSame) {
  for (const std::string& at_top : {std::string(), std::string(kTeamOfTwo)}) {
    const Settings settings =
        settings_of(sample(R"(, "budget_mbit": 0.3)", R"(, "connections": 100)", at_top));
    const Settings again = settings_of(file_of(settings));
    EXPECT_THAT(changes(settings, again), IsEmpty());
    EXPECT_EQ(file_of(again), file_of(settings));
    EXPECT_EQ(tag_of(again), tag_of(settings));
  }
}

/// Collects the paths of all values, as in the table of keys.
void gather(const codec::Value& value, const std::string& path, std::vector<std::string>& paths) {
  if (const auto* members = std::get_if<codec::Value::Object>(&value.is)) {
    for (const auto& [name, member] : *members)
      gather(member, path.empty() ? name : path + "." + name, paths);
  } else if (const auto* items = std::get_if<codec::Value::Array>(&value.is)) {
    for (const codec::Value& item : *items) gather(item, path + "[]", paths);
  } else {
    paths.push_back(path);
  }
}

TEST(WrittenSettings, HaveEachKeyInTheOrderOfTheTable) {
  std::vector<std::string> written, known;
  gather(value_of(with_an_item_of_each()), "", written);
  for (const Key& key : keys()) known.emplace_back(key.path);
  EXPECT_EQ(written, known);
}

TEST(WrittenSettings, LackAnEarlierVersionsKeyWithoutEffect) {
  const Settings settings = settings_of(sample(
      "", "",
      R"(, "robots": [{"name": "ugv1", "voxel_metres": 0.0},)"
      R"( {"name": "uav1", "clouds": "whole", "voxel_metres": 0.1}, {"name": "uav2", "voxel_metres": 10}])"));
  EXPECT_THAT(settings.without_effect, ElementsAre("robots[1].voxel_metres", "robots[2].voxel_metres"))
      << "0 was the default and had no effect";
  EXPECT_EQ(file_of(settings).find("voxel"), std::string::npos);
}

TEST(WrittenSettings, AreOnReadableLines) {
  const std::string file = file_of(settings_of(sample("", "", kTeamOfTwo)));
  EXPECT_THAT(file, HasSubstr("{\n  \"version\": 1,\n  \"command_post\": {\n    \"scoring\": "
                              "{\"address\":\"10.100.1.200\",\"port\":8000},\n"));
  EXPECT_THAT(file, HasSubstr("\n    {\n      \"name\": \"ugv2\",\n      \"alias\": \"husky-2\",\n"));
  EXPECT_THAT(file, HasSubstr("\n      \"colour\": \"auto\"\n    }\n  ],\n"));
  EXPECT_TRUE(file.ends_with("\n}\n"));
}

TEST(SettingsTags, DifferIfAnySettingDiffers) {
  const std::string tag = tag_of(settings_of(sample()));
  EXPECT_EQ(tag.size(), 16u);
  EXPECT_NE(tag_of(settings_of(sample(R"(, "budget_mbit": 99)"))), tag);
  EXPECT_NE(tag_of(settings_of(sample("", "", kTeamOfTwo))), tag);
}

TEST(SettingsChanges, NameEachChangedSetting) {
  const Settings before = settings_of(sample());
  EXPECT_THAT(changes(before, before), IsEmpty());
  Settings after = before;
  after.team.listen.front().port = 8080;
  after.reports.review = dispatch::Review::All;
  after.command_post.budget_mbit = 20.5;
  EXPECT_THAT(sentences(changes(before, after)),
              ElementsAre("command_post.budget_mbit: 100.0 -> 20.5", "team.listen[0].port: 8000 -> 8080",
                          R"(reports.review: "off" -> "all")"));
}

TEST(SettingsChanges, IdentifyItemsByNameNotByPlace) {
  const Settings before = settings_of(sample("", "", kTeamOfTwo));
  Settings after = before;
  after.robots.erase(after.robots.begin());
  after.robots.front().alias = "";
  after.robots.push_back({"uav1", "", queues::Clouds::Whole});
  EXPECT_THAT(
      sentences(changes(before, after)),
      ElementsAre(R"(robots[ugv1].name: "ugv1" -> null)", R"(robots[ugv1].alias: "" -> null)",
                  R"(robots[ugv1].clouds: "auto" -> null)", R"(robots[ugv1].precision: "exact" -> null)",
                  R"(robots[ugv1].colour: "auto" -> null)", R"(robots[ugv2].alias: "husky-2" -> "")",
                  R"(robots[uav1].name: null -> "uav1")", R"(robots[uav1].alias: null -> "")",
                  R"(robots[uav1].clouds: null -> "whole")", R"(robots[uav1].precision: null -> "exact")",
                  R"(robots[uav1].colour: null -> "auto")"));
}

}  // namespace
}  // namespace adit::settings
