#include "icd/suggestion.hpp"

#include <gtest/gtest.h>

namespace adit::icd {
namespace {

constexpr std::string_view kKnown[] = {"status", "reports", "run", "settings", "at"};

TEST(Suggestion, IsTheNearestWord) {
  const struct {
    std::string_view word, meant;
  } cases[] = {{"stat", "status"},      // a prefix
               {"statuses", "status"},  // and a longer word
               {"satus", "status"},    {"reprots", "reports"}, {"seting", "settings"}, {"rum", "run"}};
  for (const auto& [word, meant] : cases) EXPECT_EQ(nearest(word, kKnown), meant) << word;
}

TEST(Suggestion, IsAbsentIfNoWordIsNear) {
  for (const std::string_view word : {"", "x", "xy", "help", "7", "aaaaaaaaaa"})
    EXPECT_EQ(nearest(word, kKnown), std::nullopt) << word;
  EXPECT_EQ(nearest(std::string("status").append(59, 's'), kKnown), std::nullopt) << "too long to compare";
  EXPECT_EQ(nearest("status", {}), std::nullopt);
}

TEST(Suggestion, AllowsAtMostTheGivenDifferences) {
  constexpr std::string_view kShort[] = {"vent"};
  EXPECT_EQ(nearest("test", kShort), "vent");
  EXPECT_EQ(nearest("test", kShort, 0), std::nullopt);
  EXPECT_EQ(nearest("vant", kShort, 0), "vent");
}

TEST(Suggestion, IsWrittenAsAQuestion) {
  EXPECT_EQ(did_you_mean("stat", kKnown), "; did you mean status?");
  EXPECT_EQ(did_you_mean("xyzzy", kKnown), "");
}

}  // namespace
}  // namespace adit::icd
