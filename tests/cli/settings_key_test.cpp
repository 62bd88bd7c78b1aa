#include <gmock/gmock.h>

#include "cli/settings.hpp"
#include "codec/json.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;

api::KeyRow key(const std::string& path, const std::string& meaning, const std::string& range) {
  return {.path = path,
          .meaning = meaning,
          .kind = "text",
          .required = true,
          .default_value = {},
          .range = range};
}
api::KeyRow key(const std::string& path, const std::string& meaning, const std::string& range,
                codec::Value usual) {
  api::KeyRow row = key(path, meaning, range);
  row.required = false;
  row.default_value = std::move(usual);
  return row;
}

/// Adit's answer with a few keys.
api::SetupView answer() {
  return {.settings = *codec::parse_json(R"({"reports": {"review": "off", "near_metres": 5},
            "robots": [{"name": "r1", "alias": "husky"}, {"name": "r2", "alias": ""}], "courses": []})"),
          .tag = "",
          .trouble = "",
          .tokens = {},
          .keys = {key("reports.review", "What is held.", "\"off\" or \"all\"", {"off"}),
                   key("reports.near_metres", "How near.", "0 to 1000", {5.0}),
                   key("robots[].name", "Its name.", "letters"),
                   key("robots[].alias", "Its alias.", "text", {""}),
                   key("courses[].name", "A course.", "letters")}};
}

std::string text_of_key(const std::string& name) {
  const auto keys = keys_named(answer(), name);
  return keys ? text_of(*keys, false) : keys.error().sentence;
}

TEST(SettingsKey, IsShownWithItsValueAndBounds) {
  EXPECT_EQ(text_of_key("reports.review"),
            "  reports.review  off\n  What is held.\n  allowed: \"off\" or \"all\"; default: off\n");
}

TEST(SettingsKey, OfAListIsShownForEachItem) {
  EXPECT_EQ(text_of_key("robots[].alias"),
            "  robots[0].alias  husky\n  robots[1].alias  (empty)\n  Its alias.\n  allowed: text; default: "
            "(empty)\n");
  EXPECT_EQ(text_of_key("courses[].name"),
            "  courses[].name  (none)\n  A course.\n  allowed: letters; required\n");
}

TEST(SettingsKey, OfAnItemIsShownForThatItem) {
  EXPECT_EQ(text_of_key("robots[r1].alias"),
            "  robots[r1].alias  husky\n  Its alias.\n  allowed: text; default: (empty)\n");
  EXPECT_EQ(keys_named(answer(), "robots[1]")->size(), 2);
  EXPECT_EQ(text_of_key("robots[ugv9].alias"), "robots has no item ugv9: there are r1, r2");
  EXPECT_EQ(text_of_key("courses[A].name"), "courses has no item A: it is empty");
  EXPECT_EQ(text_of_key("robots[r1].alas"),
            "no such settings key: robots[r1].alas; did you mean robots[].alias?");
}

TEST(SettingsKey, MayBeThePrefixOfSeveral) {
  EXPECT_EQ(keys_named(answer(), "reports")->size(), 2);
  EXPECT_EQ(keys_named(answer(), "robots")->size(), 2);
  EXPECT_EQ(keys_named(answer(), "robots[]")->size(), 2);
  EXPECT_THAT(codec::write_json(json_of(*keys_named(answer(), "robots[].name"))),
              HasSubstr(R"("values":{"robots[0].name":"r1","robots[1].name":"r2"})"));
}

TEST(SettingsKey, UnknownHasASuggestion) {
  EXPECT_EQ(text_of_key("reports.reviw"),
            "no such settings key: reports.reviw; did you mean reports.review?");
  EXPECT_EQ(text_of_key("xyzzy"), "no such settings key: xyzzy");
}

}  // namespace
}  // namespace adit::cli
