#include <gmock/gmock.h>

#include "box/self_test.hpp"
#include "settings/sample.hpp"

namespace adit::box {
namespace {

using settings::Address;
using testing::HasSubstr;
using testing::StartsWith;

const settings::Settings& written() {
  static const settings::Settings settings =
      *settings::parse(settings::sample("", "",
                                        R"(, "courses": [{"name": "B",)"
                                        R"("scoring": {"address": "10.100.2.200", "port": 8000},)"
                                        R"("mapping": {"address": "10.100.2.201", "port": 8000}}])"));
  return settings;
}

icd::BearerToken token(const char* text) {
  return *icd::BearerToken::parse(text);
}
const host::Secrets kSecrets = {.tokens = {{"scoring", token("common-scoring")},
                                           {"mapping", token("common-mapping")},
                                           {"course.B.scoring", token("own-scoring")}}};

TestTarget good(const api::Candidate& candidate, const settings::Settings& beside = written()) {
  const auto tried = tried_of(candidate, beside, kSecrets);
  EXPECT_TRUE(tried) << tried.error().sentence;
  return tried.value_or(TestTarget{});
}
settings::Settings with_course_b() {
  settings::Settings settings = written();
  settings.command_post.course = "B";
  return settings;
}
std::string why_not(const api::Candidate& candidate) {
  const auto tried = tried_of(candidate, written(), kSecrets);
  EXPECT_FALSE(tried);
  if (tried) return "";
  EXPECT_EQ(tried.error().status, icd::Status::UnprocessableEntity);
  return tried.error().sentence;
}

TEST(TestCandidate, EmptyMeansTheSettingsInUse) {
  const TestTarget plain = good({});
  EXPECT_EQ(plain.post.scoring, (Address{"10.100.1.200", 8000}));
  EXPECT_EQ(plain.scoring->reveal(), "common-scoring");
  const TestTarget course = good({}, with_course_b());
  EXPECT_EQ(course.post.mapping, (Address{"10.100.2.201", 8000}));
  EXPECT_EQ(course.scoring->reveal(), "own-scoring");
  EXPECT_EQ(course.mapping->reveal(), "common-mapping");
}

TEST(TestCandidate, CourseHasItsAddressesAndTokens) {
  const TestTarget there = good({.course = "B", .scoring = {}, .mapping = {}});
  EXPECT_EQ(there.post.scoring, (Address{"10.100.2.200", 8000}));
  EXPECT_EQ(there.scoring->reveal(), "own-scoring");
  EXPECT_EQ(there.post.course, "B");
  const TestTarget back = good({.course = "", .scoring = {}, .mapping = {}}, with_course_b());
  EXPECT_EQ(back.post.scoring, (Address{"10.100.1.200", 8000}));
  EXPECT_EQ(back.scoring->reveal(), "common-scoring");
  EXPECT_THAT(why_not({.course = "C", .scoring = {}, .mapping = {}}),
              HasSubstr("course: no course is called C"));
}

TEST(TestCandidate, TypedValuesReplaceTheSettings) {
  api::Candidate typed;
  typed.scoring = {.address = "10.100.3.200", .port = {}, .token = token("typed-scoring")};
  typed.mapping = {.address = {}, .port = 9000, .token = {}};
  for (const settings::Settings& beside : {written(), with_course_b()}) {
    const TestTarget tried = good(typed, beside);
    EXPECT_EQ(tried.post.scoring, (Address{"10.100.3.200", 8000}));
    EXPECT_EQ(tried.post.mapping.port, 9000);
    EXPECT_EQ(tried.scoring->reveal(), "typed-scoring");
    EXPECT_EQ(tried.mapping->reveal(), "common-mapping");
    std::string said = "no such token: typed-scoring";
    tried.typed.strike_from(said);
    EXPECT_EQ(said, "no such token: [token]");
  }
}

TEST(TestCandidate, UnsavableValuesAreRejected) {
  const auto address = [](const char* text) {
    api::Candidate typed;
    typed.mapping = {.address = text, .port = {}, .token = {}};
    return why_not(typed);
  };
  EXPECT_THAT(address("10.100.1"), StartsWith("mapping.address: expected"));
  EXPECT_THAT(address("0.0.0.0"), HasSubstr("mapping.address: 0.0.0.0 is no address of one machine"));
  api::Candidate own;
  own.scoring = {.address = "127.0.0.1", .port = 8000, .token = {}};
  EXPECT_THAT(why_not(own), HasSubstr("Adit would post to itself"));
}

}  // namespace
}  // namespace adit::box
