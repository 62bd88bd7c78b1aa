#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "panel/panel.hpp"

namespace adit::panel {
namespace {

using namespace std::chrono_literals;

/// How long a pattern is on in two seconds, and how often it turns on.
std::pair<Milliseconds, int> lit_and_turns(Pattern pattern) {
  Milliseconds lit{};
  int turned_on = 0;
  for (Milliseconds at = 8s; at < 10s; ++at) {
    const bool now = repeated_moment(steps_of(pattern), at).lit;
    lit += now ? 1ms : 0ms;
    turned_on += now && !repeated_moment(steps_of(pattern), at - 1ms).lit ? 1 : 0;
  }
  return {lit, turned_on};
}

TEST(Patterns, MatchTheReadme) {
  EXPECT_EQ(lit_and_turns(Pattern::Off), std::pair(0ms, 0));
  EXPECT_EQ(lit_and_turns(Pattern::On), std::pair(2000ms, 0));
  EXPECT_EQ(lit_and_turns(Pattern::Slow), std::pair(1000ms, 2));
  EXPECT_EQ(lit_and_turns(Pattern::Fast), std::pair(1000ms, 8));
  EXPECT_EQ(lit_and_turns(Pattern::Twice), std::pair(500ms, 4));
  EXPECT_EQ(lit_and_turns(Pattern::Flash), std::pair(125ms, 1));
  EXPECT_EQ(lit_and_turns(Pattern::Wink), std::pair(1750ms, 1));
  EXPECT_EQ(lit_and_turns(Pattern::Rush), std::pair(1000ms, 20));
}

TEST(Patterns, DifferInMoreThanColour) {
  std::set<std::pair<Milliseconds, int>> all;
  for (const Pattern pattern : kPatterns) {
    if (pattern != Pattern::Digits) all.insert(lit_and_turns(pattern));
  }
  EXPECT_EQ(all.size(), kPatterns.size() - 1);
}

TEST(Patterns, AreVisibleWithinTwoSeconds) {
  for (const Pattern pattern : kPatterns) EXPECT_LE(length_of(steps_of(pattern)), 2s) << name_of(pattern);
}

TEST(Patterns, BeginLit) {
  for (const Pattern pattern : kPatterns) {
    if (pattern == Pattern::Off || pattern == Pattern::Digits) continue;
    EXPECT_TRUE(repeated_moment(steps_of(pattern), 0ms).lit) << name_of(pattern);
  }
}

TEST(Steps, TellWhenTheNextBegins) {
  const Step kSteps[] = {{true, 100ms}, {false, 300ms}};
  EXPECT_EQ(repeated_moment(kSteps, 0ms).lasts, 100ms);
  EXPECT_EQ(repeated_moment(kSteps, 99ms).lasts, 1ms);
  EXPECT_EQ(repeated_moment(kSteps, 100ms).lasts, 300ms);
  EXPECT_EQ(repeated_moment(kSteps, 450ms).lasts, 50ms);
  EXPECT_EQ(single_moment(kSteps, 399ms).lasts, 1ms);
  EXPECT_EQ(single_moment(kSteps, 400ms).lasts, std::nullopt);
  EXPECT_FALSE(single_moment(kSteps, 400ms).lit);
  EXPECT_EQ(repeated_moment(steps_of(Pattern::On), 5s).lasts, std::nullopt)
      << "a steady light has no next step";
}

TEST(Frame, LastsUntilItsFirstLightChanges) {
  const Frame frame = frame_of({Pattern::On, Pattern::Slow, Pattern::Fast, Pattern::Off}, 1100ms);
  EXPECT_EQ(frame.lit, (Lit{true, true, true, false}));
  EXPECT_EQ(frame.lasts, 25ms);
  EXPECT_EQ(frame_of({Pattern::On, Pattern::On, Pattern::Off, Pattern::Digits}, 0ms).lasts, std::nullopt);
}

TEST(Names, AreDistinct) {
  std::set<std::string_view> names;
  for (const Light light : kLights) names.insert(name_of(light));
  for (const Pattern pattern : kPatterns) names.insert(name_of(pattern));
  EXPECT_EQ(names.size(), kLights.size() + kPatterns.size());
}

}  // namespace
}  // namespace adit::panel
