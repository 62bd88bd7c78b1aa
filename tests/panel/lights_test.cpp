#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "panel/panel.hpp"

namespace adit::panel {
namespace {

constexpr Condition kWell = {.serving = true, .scoring_connected = true, .mapping_connected = true};

Condition but(void (*change)(Condition&)) {
  Condition condition = kWell;
  change(condition);
  return condition;
}

struct Case {
  const char* what;
  Condition condition;
  Lights lights;
};

constexpr auto kOff = Pattern::Off, kOn = Pattern::On, kSlow = Pattern::Slow, kFast = Pattern::Fast;

const Case kCases[] = {
    {"all is well", kWell, {kOn, kOn, kOn, kOff}},
    {"not serving", but([](Condition& c) { c.serving = false; }), {kFast, kOn, kOn, kOff}},
    {"scoring not connected", but([](Condition& c) { c.scoring_connected = false; }), {kOn, kOff, kOn, kOff}},
    {"scoring failing", but([](Condition& c) { c.scoring_failing = true; }), {kOn, kFast, kOn, kOff}},
    {"a report waits", but([](Condition& c) { c.report_waiting = true; }), {kOn, kSlow, kOn, kOff}},
    {"a report waits, scoring not connected",
     but([](Condition& c) { c.report_waiting = true, c.scoring_connected = false; }),
     {kOn, kOff, kOn, kOff}},
    {"a report waits, scoring failing",
     but([](Condition& c) { c.report_waiting = c.scoring_failing = true, c.scoring_connected = false; }),
     {kOn, kFast, kOn, kOff}},
    {"mapping not connected", but([](Condition& c) { c.mapping_connected = false; }), {kOn, kOn, kOff, kOff}},
    {"mapping failing", but([](Condition& c) { c.mapping_failing = true; }), {kOn, kOn, kFast, kOff}},
    {"the operator must act", but([](Condition& c) { c.needs_operator = true; }), {kOn, kOn, kOn, kFast}},
    {"at start", {}, {kFast, kOff, kOff, kOff}},
};

TEST(Lights, ShowTheTableOfTheReadme) {
  for (const Case& row : kCases) EXPECT_EQ(lights_for(row.condition), row.lights) << row.what;
}

TEST(Lights, AreAllDarkInNoConditionAtAll) {
  for (unsigned bits = 0; bits < 128; ++bits) {
    const auto bit = [bits](unsigned n) { return (bits >> n & 1u) != 0; };
    const Lights lights = lights_for({bit(0), bit(1), bit(2), bit(3), bit(4), bit(5), bit(6)});
    for (const Pattern pattern : lights)
      EXPECT_NE(pattern, Pattern::Twice) << "that is for telling boxes apart";
    EXPECT_NE(lights[0], Pattern::Off) << "a dark health light means that Adit is not running";
  }
}

TEST(Patterns, BlinkAtTheirRateForHalfTheTime) {
  const auto lit_of_a_second = [](Pattern pattern) {
    int on = 0, turned_on = 0;
    for (std::uint64_t ms = 7000; ms < 8000; ++ms) {
      on += lit(pattern, ms) ? 1 : 0;
      turned_on += lit(pattern, ms) && !lit(pattern, ms - 1) ? 1 : 0;
    }
    return std::pair(on, turned_on);
  };
  EXPECT_EQ(lit_of_a_second(Pattern::Off), std::pair(0, 0));
  EXPECT_EQ(lit_of_a_second(Pattern::On), std::pair(1000, 0));
  EXPECT_EQ(lit_of_a_second(Pattern::Slow), std::pair(500, 1));
  EXPECT_EQ(lit_of_a_second(Pattern::Fast), std::pair(500, 4));
  EXPECT_EQ(lit_of_a_second(Pattern::Twice), std::pair(250, 2));
}

TEST(Patterns, BeginLit) {
  EXPECT_TRUE(lit(Pattern::Slow, 0));
  EXPECT_TRUE(lit(Pattern::Fast, 0));
}

TEST(Names, AreDistinct) {
  std::set<std::string_view> names;
  for (const Light light : kLights) names.insert(name_of(light));
  for (const Pattern pattern : {kOff, kOn, kSlow, kFast, Pattern::Twice}) names.insert(name_of(pattern));
  EXPECT_EQ(names.size(), 9u);
}

TEST(PanelReadme, HasARowForEachLight) {
  std::ifstream stream(ADIT_SOURCE_DIR "/firmware/panel/README.md");
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  for (const Light light : kLights) {
    EXPECT_NE(text.find("\n| " + std::string(name_of(light)) + " |"), std::string::npos) << name_of(light);
  }
}

}  // namespace
}  // namespace adit::panel
