#include <gtest/gtest.h>

#include "settings/settings.hpp"

namespace adit::settings {
namespace {

std::string place_of(const std::string& path, const std::string& json, const std::string& what = "") {
  std::vector<Error> errors{{path, what}};
  find_places(json, errors);
  return errors.front().at;
}

const std::string kFile = R"({
  "reports": {"review": "é", "near_metres": 5},
  "robots": [
    {"name": "a\"}", "alias": 3},
    {"name": "b"}
  ],
  "late": {}
})";

TEST(Places, AreThoseOfTheKeys) {
  EXPECT_EQ(place_of("reports.review", kFile), "line 2, column 15");
  EXPECT_EQ(place_of("reports.near_metres", kFile), "line 2, column 30") << "counted in characters";
  EXPECT_EQ(place_of("robots[0].alias", kFile), "line 4, column 22");
  EXPECT_EQ(place_of("robots[1].name", kFile), "line 5, column 6");
  EXPECT_EQ(place_of("late", kFile), "line 7, column 3");
}

TEST(Places, OfMissingKeysAreThoseOfTheObjectThatLacksThem) {
  EXPECT_EQ(place_of("robots[1].alias", kFile), "line 5, column 5");
  EXPECT_EQ(place_of("reports.review_all", kFile), "line 2, column 3");
  EXPECT_EQ(place_of("version", kFile), "line 1, column 1");
}

TEST(Places, OfAFaultOfTheSyntaxIsItsByte) {
  EXPECT_EQ(place_of("", "{\n  x", "not well-formed JSON at byte 4: expected a key"), "line 2, column 3");
  EXPECT_EQ(place_of("", "{}", "two lights have one line"), "");
}

TEST(Places, OfADamagedTextDoNotMatter) {
  for (std::size_t size = 0; size < kFile.size(); ++size) place_of("robots[1].name", kFile.substr(0, size));
}

}  // namespace
}  // namespace adit::settings
