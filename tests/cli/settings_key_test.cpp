#include "cli/settings_key.hpp"

#include <gmock/gmock.h>

#include "codec/json.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;

/// What Adit says, of a few keys.
codec::Value answer() {
  auto value = codec::parse_json(R"({
    "settings": {"reports": {"review": "off", "near_metres": 5},
                 "robots": [{"name": "r1", "alias": "husky"}, {"name": "r2", "alias": ""}], "courses": []},
    "keys": [
      {"path": "reports.review", "meaning": "What is held.", "required": false, "default": "off", "range": "\"off\" or \"all\""},
      {"path": "reports.near_metres", "meaning": "How near.", "required": false, "default": 5, "range": "0 to 1000"},
      {"path": "robots[].name", "meaning": "Its name.", "required": true, "default": null, "range": "letters"},
      {"path": "robots[].alias", "meaning": "Its alias.", "required": false, "default": "", "range": "text"},
      {"path": "courses[].name", "meaning": "A course.", "required": true, "default": null, "range": "letters"}]})");
  EXPECT_TRUE(value) << value.error();
  return value.value_or(codec::Value{});
}

std::string text_of_key(const std::string& name) {
  const auto keys = keys_named(answer(), name);
  return keys ? text_of(*keys, false) : keys.error();
}

TEST(AKey, IsShownWithItsValueAndWhatItMayBe) {
  EXPECT_EQ(text_of_key("reports.review"),
            "  reports.review  off\n  What is held.\n  allowed: \"off\" or \"all\"; default: off\n");
}

TEST(AKey, OfAListIsShownForEachItem) {
  EXPECT_EQ(text_of_key("robots[].alias"),
            "  robots[0].alias  husky\n  robots[1].alias  (empty)\n  Its alias.\n  allowed: text; default: "
            "(empty)\n");
  EXPECT_EQ(text_of_key("courses[].name"),
            "  courses[].name  (none)\n  A course.\n  allowed: letters; required\n");
}

TEST(AKey, MayBeTheBeginningOfSeveral) {
  EXPECT_EQ(keys_named(answer(), "reports")->size(), 2);
  EXPECT_EQ(keys_named(answer(), "robots")->size(), 2);
  EXPECT_EQ(keys_named(answer(), "robots[]")->size(), 2);
  EXPECT_THAT(codec::write_json(json_of(*keys_named(answer(), "robots[].name"))),
              HasSubstr(R"("values":{"robots[0].name":"r1","robots[1].name":"r2"})"));
}

TEST(AKey, ThatIsNoneIsAskedAbout) {
  EXPECT_EQ(text_of_key("reports.reviw"),
            "no such settings key: reports.reviw; did you mean reports.review?");
  EXPECT_EQ(text_of_key("xyzzy"), "no such settings key: xyzzy");
  EXPECT_EQ(keys_named(codec::Value{}, "reports").error(), "cannot read Adit's answer: it has no keys");
}

}  // namespace
}  // namespace adit::cli
