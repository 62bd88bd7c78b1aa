#include "box/lights.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "loop/turn_until.hpp"
#include "panel/watched.hpp"
#include "panel/watched_lines.hpp"

namespace adit::box {
namespace {

using namespace std::chrono_literals;
using panel::Lit;
using panel::Pattern;
using panel::State;
using panel::WatchedLines;

constexpr std::size_t kHealth = panel::index_of(panel::Light::Health),
                      kMapping = panel::index_of(panel::Light::Mapping),
                      kAttention = panel::index_of(panel::Light::Attention);

class LightsTest : public testing::Test {
 protected:
  void be_well() {
    for (const State state : {State::Serving, State::ScoringConnected, State::MappingConnected}) {
      lights.set(state, true);
    }
  }

  loop::Loop loop;
  WatchedLines::Seen seen;
  Lights lights{loop, std::make_unique<WatchedLines>(seen)};
};

TEST_F(LightsTest, SetTheLinesOnlyWhenSomethingChanges) {
  be_well();
  const std::size_t changes = seen.shown.size();
  EXPECT_EQ(seen.shown.back(), (Lit{true, true, true, false}));
  be_well();
  lights.set(State::NeedsOperator, false);
  EXPECT_EQ(seen.shown.size(), changes);
}

TEST_F(LightsTest, AreAllDarkAtFirst) {
  lights.set(State::Serving, false);
  ASSERT_EQ(seen.shown.size(), 1u) << "whatever they showed before";
  EXPECT_EQ(seen.shown.back(), Lit{});
}

TEST_F(LightsTest, BlinkByTheLoopsTimer) {
  be_well();
  lights.set(State::NeedsOperator, true);
  loop::Duration took = 1h;
  // A busy machine takes longer now and then.
  for (int attempt = 0; attempt < 10 && took > 1500ms; ++attempt) {
    const auto began = loop.now();
    seen.shown.clear();
    EXPECT_TRUE(loop::turn_until(loop, [&] { return seen.shown.size() >= 9; }));
    for (std::size_t i = 1; i < 9; ++i) EXPECT_NE(seen.shown[i][kAttention], seen.shown[i - 1][kAttention]);
    took = loop.now() - began;
    EXPECT_GT(took, 800ms);
  }
  EXPECT_LT(took, 1500ms) << "eight steps of 125 ms";
}

TEST_F(LightsTest, KeepTheirTimeWhileTheyAreToldTheSameOverAndOver) {
  lights.set(State::NeedsOperator, true);
  seen.shown.clear();
  const auto began = loop.now();
  EXPECT_TRUE(loop::turn_until(loop, [&] {
    lights.set(State::NeedsOperator, true);
    loop.turn(10ms);
    return seen.shown.size() >= 6 && loop.now() - began > 1s;
  }));
  EXPECT_LE(static_cast<long>(seen.shown.size()), 1 + (loop.now() - began) / 125ms);
}

TEST_F(LightsTest, AllFlashTogetherWhileTheBoxIsIdentifiedAndThenTellOfTheOthersAgain) {
  be_well();
  lights.set_for(State::Identify, 1h);
  constexpr panel::Lights kTwice = {Pattern::Twice, Pattern::Twice, Pattern::Twice, Pattern::Twice};
  EXPECT_EQ(lights.shown(), kTwice);
  lights.set(State::MappingConnected, false);
  EXPECT_EQ(lights.shown(), kTwice) << "whatever happens meanwhile";
  EXPECT_GT(lights.left(State::Identify).value_or(0ms), 0ms);
  const auto showed = [&](const Lit& lit) { return std::ranges::find(seen.shown, lit) != seen.shown.end(); };
  EXPECT_TRUE(loop::turn_until(loop, [&] { return showed(Lit{}) && showed(Lit{true, true, true, true}); }));
  lights.set_for(State::Identify, 100ms);
  EXPECT_TRUE(loop::turn_until(loop, [&] { return lights.shown() != kTwice; }));
  EXPECT_EQ(lights.left(State::Identify), std::nullopt);
  EXPECT_FALSE(lights.has(State::Identify));
  EXPECT_EQ(lights.shown()[kMapping], Pattern::Off);
  EXPECT_EQ(seen.shown.back(), (Lit{true, true, false, false}));
}

TEST_F(LightsTest, PlayDigitsOnceFromTheirBeginningOnAttentionAlone) {
  be_well();
  loop.turn(30ms);
  const Lit dark{}, digit{false, false, false, true}, well{true, true, true, false};
  const std::vector all{dark, digit, dark, digit, dark, well};
  seen.shown.clear();
  // A busy machine may sleep through one.
  for (int attempt = 0; attempt < 20 && seen.shown != all; ++attempt) {
    seen.shown.clear();
    lights.play_digits({{false, 100ms}, {true, 100ms}, {false, 100ms}, {true, 200ms}, {false, 100ms}});
    EXPECT_EQ(lights.shown()[kAttention], Pattern::Digits);
    EXPECT_TRUE(loop::turn_until(loop, [&] { return !lights.has(State::Address); }));
  }
  EXPECT_EQ(seen.shown, all);
}

TEST_F(LightsTest, ClearAStateThatWouldEndByItself) {
  lights.set(State::Serving, true);
  lights.set_for(State::Identify, 1h);
  lights.set(State::Identify, false);
  EXPECT_EQ(lights.left(State::Identify), std::nullopt);
  EXPECT_EQ(lights.shown()[kHealth], Pattern::On);
}

TEST_F(LightsTest, GoOnAfterThePanelFails) {
  seen.fail = true;
  lights.set(State::Serving, true);
  lights.set(State::ScoringConnected, true);
  EXPECT_EQ(seen.shown.size(), 2u);
}

TEST_F(LightsTest, AreTriedAgainAfterThePanelFailedThoughNothingChanges) {
  seen.fail = true;
  lights.set(State::Serving, true);
  EXPECT_EQ(lights.trouble(), "gpiochip0: gone");
  seen.fail = false;
  seen.shown.clear();
  lights.set(State::Serving, true);
  EXPECT_TRUE(seen.shown.empty()) << "not as often as it is asked for";
  EXPECT_TRUE(loop::turn_until(loop, [&] { return !seen.shown.empty(); }));
  EXPECT_EQ(seen.shown, (std::vector{Lit{true, false, false, false}}));
  EXPECT_TRUE(loop::turn_until(loop, [&] { return lights.trouble().empty(); }));
}

TEST_F(LightsTest, AreToldOverAndOverWhereSomebodyWatchesWhetherTheLoopTurns) {
  WatchedLines::Seen watched{.shown = {}, .is_watched = true};
  be_well();
  lights.let_go();
  lights.take(std::make_unique<WatchedLines>(watched));
  EXPECT_TRUE(loop::turn_until(loop, [&] { return watched.shown.size() >= 4; }));
  for (const Lit& lit : watched.shown) EXPECT_EQ(lit, (Lit{true, true, true, false}));
  watched.fail = true;
  const std::size_t before = watched.shown.size();
  EXPECT_TRUE(loop::turn_until(loop, [&] { return watched.shown.size() > before + 1; })) << "and tried again";
  lights.let_go();
  watched.shown.clear();
  lights.set(State::NeedsOperator, true);
  loop.turn(10ms);
  EXPECT_TRUE(watched.shown.empty());
}

TEST_F(LightsTest, AreNotToldTheSameAgainWhereNobodyWatches) {
  be_well();
  EXPECT_TRUE(loop::turn_until(loop, [&] { return !seen.shown.empty(); }));
  const std::size_t told = seen.shown.size();
  const auto began = loop.now();
  EXPECT_TRUE(loop::turn_until(loop, [&] { return loop.now() - began > 2 * panel::Watched::kBeat; }));
  EXPECT_EQ(seen.shown.size(), told);
}

TEST_F(LightsTest, ShowTheSameOnOtherLines) {
  be_well();
  WatchedLines::Seen other;
  lights.let_go();
  lights.set(State::NeedsOperator, true);  // nothing can be shown meanwhile
  lights.take(std::make_unique<WatchedLines>(other));
  EXPECT_EQ(other.shown, (std::vector<Lit>{{true, true, true, true}}));
}

}  // namespace
}  // namespace adit::box
