#include <gtest/gtest.h>

#include "update/bundle.hpp"

namespace adit::update {
namespace {

TEST(Version, IsOrderedBySemanticVersioning) {
  const std::vector<std::string> ascending = {"0.0.9",         "0.1.0",
                                              "0.1.1",         "0.2.0-alpha",
                                              "0.2.0-alpha.1", "0.2.0-alpha.beta",
                                              "0.2.0-beta",    "0.2.0-beta.2",
                                              "0.2.0-beta.11", "0.2.0-rc.1",
                                              "0.2.0",         "0.10.0",
                                              "1.0.0-0.3.7",   "1.0.0",
                                              "2.0.0",         "18446744073709551615.0.0"};
  for (std::size_t i = 0; i < ascending.size(); ++i) {
    for (std::size_t j = 0; j < ascending.size(); ++j) {
      const auto left = Version::parse(ascending[i]), right = Version::parse(ascending[j]);
      ASSERT_TRUE(left && right) << ascending[i] << ' ' << ascending[j];
      EXPECT_EQ(*left <=> *right, i <=> j) << ascending[i] << " and " << ascending[j];
    }
  }
}

TEST(Version, IgnoresBuildMetadata) {
  EXPECT_EQ(Version::parse("1.0.0+a"), Version::parse("1.0.0+b-2.c"));
  EXPECT_EQ(Version::parse("1.0.0-rc.1+a"), Version::parse("1.0.0-rc.1"));
}

TEST(Version, RejectsOtherForms) {
  for (const char* text : {"",
                           "1",
                           "1.2",
                           "1.2.3.4",
                           "v1.2.3",
                           "1.2.x",
                           "01.2.3",
                           "1.02.3",
                           "-1.2.3",
                           "1.2.3-",
                           "1.2.3-a..b",
                           "1.2.3-01",
                           "1.2.3+",
                           "1.2.3 ",
                           " 1.2.3",
                           "1.2.3-a_b",
                           "1.2.3-\xc3\xa4",
                           "1..3",
                           "18446744073709551616.0.0",
                           "0x1.0.0"}) {
    EXPECT_FALSE(Version::parse(text)) << text;
  }
  EXPECT_FALSE(Version::parse("1.2.3-" + std::string(Version::kLongest, 'a')));
}

}  // namespace
}  // namespace adit::update
