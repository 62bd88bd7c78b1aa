#include "panel/states.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <set>

namespace adit::panel {
namespace {

constexpr auto kOff = Pattern::Off, kOn = Pattern::On, kSlow = Pattern::Slow, kFast = Pattern::Fast,
               kFlash = Pattern::Flash, kWink = Pattern::Wink;

constexpr std::initializer_list<LightState> kGoodStates = {LightState::Serving, LightState::ScoringConnected,
                                                           LightState::MappingConnected};

Lights shown(std::initializer_list<LightState> asserted) {
  States states;
  for (const LightState state : asserted) states.set(state, true);
  return states.current_lights();
}

Lights good_except(std::initializer_list<LightState> more) {
  States states;
  for (const LightState state : kGoodStates) states.set(state, true);
  for (const LightState state : more) states.set(state, true);
  return states.current_lights();
}

Lights all(Pattern pattern) {
  return {pattern, pattern, pattern, pattern};
}

TEST(States, OfAHealthyBoxAreThreeSteadyLights) {
  EXPECT_EQ(shown(kGoodStates), (Lights{kOn, kOn, kOn, kOff}));
}

TEST(States, AreShownEachOnItsOwnLight) {
  EXPECT_EQ(shown({}), all(kOff));
  EXPECT_EQ(shown({LightState::NotServing}), (Lights{kFast, kOff, kOff, kOff}));
  EXPECT_EQ(good_except({LightState::ScoringFailing}), (Lights{kOn, kFast, kOn, kOff}));
  EXPECT_EQ(good_except({LightState::MappingFailing}), (Lights{kOn, kOn, kFast, kOff}));
  EXPECT_EQ(good_except({LightState::ReportWaiting}), (Lights{kOn, kSlow, kOn, kOff}));
  EXPECT_EQ(good_except({LightState::NeedsOperator}), (Lights{kOn, kOn, kOn, kFast}));
  EXPECT_EQ(good_except({LightState::CommandPostUnplugged}), (Lights{kOn, kFlash, kFlash, kOff}));
  EXPECT_EQ(good_except({LightState::TeamUnplugged}), (Lights{kFlash, kOn, kOn, kOff}));
  EXPECT_EQ(good_except({LightState::UpdateRunning}), (Lights{kWink, kOn, kOn, kOff}));
  EXPECT_EQ(good_except({LightState::SetUpOpen}), (Lights{kOn, kOn, kOn, kSlow}));
}

TEST(States, OfHigherPriorityHideOthersOnlyOnTheirLights) {
  EXPECT_EQ(good_except({LightState::ScoringFailing, LightState::ReportWaiting}),
            (Lights{kOn, kFast, kOn, kOff}));
  EXPECT_EQ(
      good_except({LightState::CommandPostUnplugged, LightState::ScoringFailing, LightState::MappingFailing}),
      (Lights{kOn, kFlash, kFlash, kOff}))
      << "the reason of the failure";
  EXPECT_EQ(shown({LightState::ReportWaiting}), (Lights{kOff, kSlow, kOff, kOff}))
      << "also without a connection";
  EXPECT_EQ(good_except({LightState::NeedsOperator, LightState::SetUpOpen}), (Lights{kOn, kOn, kOn, kSlow}));
  EXPECT_EQ(shown({LightState::NotServing, LightState::TeamUnplugged}), (Lights{kFlash, kOff, kOff, kOff}));
}

TEST(States, OfWholePicturesHideAllOthers) {
  States states;
  for (const StateRow& row : state_table()) states.set(row.state, row.state != LightState::Fault);
  EXPECT_EQ(states.current_lights(), all(Pattern::Rush));
  states.set(LightState::ResetWarning, false);
  EXPECT_EQ(states.current_lights(), all(kOn)) << "the button is held";
  states.set(LightState::ButtonHeld, false);
  EXPECT_EQ(states.current_lights(), all(Pattern::Twice)) << "identify";
  states.set(LightState::Identify, false);
  EXPECT_EQ(states.current_lights(), (Lights{kOff, kOff, kOff, Pattern::Digits}));
  states.set(LightState::Address, false);
  EXPECT_EQ(states.current_lights(), (Lights{kWink, kFlash, kFlash, kSlow}));
}

TEST(States, AreGoneOnceCleared) {
  States states;
  EXPECT_TRUE(states.set(LightState::NeedsOperator, true));
  EXPECT_FALSE(states.set(LightState::NeedsOperator, true)) << "the state did not change";
  EXPECT_TRUE(states.has(LightState::NeedsOperator));
  EXPECT_TRUE(states.set(LightState::NeedsOperator, false));
  EXPECT_EQ(states.current_lights(), all(kOff));
}

TEST(StateTable, HasDistinctRows) {
  std::set<std::array<int, kLights.size()>> pictures;
  std::set<std::string_view> names;
  for (const StateRow& row : state_table()) {
    std::array<int, kLights.size()> picture{};
    for (const Light light : kLights) {
      const auto& pattern = row.patterns[index_of(light)];
      picture[index_of(light)] = pattern ? static_cast<int>(*pattern) : -1;
    }
    EXPECT_TRUE(pictures.insert(picture).second) << row.name;
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
  }
}

/// States that leave the other lights unchanged differ in their pattern on a light.
TEST(StateTable, HasOneMeaningPerPatternOfALight) {
  for (const Light light : kLights) {
    std::set<Pattern> seen;
    for (const StateRow& row : state_table()) {
      const auto& pattern = row.patterns[index_of(light)];
      const bool whole = std::ranges::all_of(row.patterns, [](const auto& each) { return each.has_value(); });
      if (!pattern || whole) continue;
      EXPECT_TRUE(seen.insert(*pattern).second) << name_of(light) << " " << row.name;
    }
  }
}

TEST(StateTable, HasADarkHealthLightOnlyIfNotRunning) {
  for (const StateRow& row : state_table()) {
    if (row.state == LightState::Address) continue;  // it ends by itself
    EXPECT_NE(row.patterns[index_of(Light::Health)], std::optional(kOff)) << row.name;
  }
}

}  // namespace
}  // namespace adit::panel
