#include <gmock/gmock.h>

#include <random>
#include <vector>

#include "forward/delivered_scene.hpp"

namespace adit::forward {
namespace {

using icd::MarkerAction;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

icd::Marker marker(const std::string& ns, std::int32_t id, double x = 0,
                   MarkerAction action = MarkerAction::Add) {
  icd::Marker marker;
  marker.ns = ns;
  marker.id = id;
  marker.action = action;
  marker.pose.position.x = x;
  return marker;
}

std::vector<std::string> names(const api::MarkerChanges& news) {
  std::vector<std::string> names;
  for (const auto& row : news.markers) names.push_back(row.marker.ns + std::to_string(row.marker.id));
  return names;
}

TEST(MarkerScene, HasTheLastStateOfEachMarker) {
  MarkerScene scene;
  scene.on_forwarded(std::vector{marker("a", 1, 5), marker("a", 2), marker("b", 1)}, 100);
  scene.on_forwarded(std::vector{marker("a", 1, 7)}, 101);
  const auto news = scene.changes(0);
  EXPECT_TRUE(news.whole);
  EXPECT_THAT(names(news), ElementsAre("a2", "b1", "a1"));
  EXPECT_EQ(news.markers[2].marker.position.x, 7);
  EXPECT_EQ(news.markers[2].at, 101);
}

TEST(MarkerScene, ListsOnlyChangesSinceAVersion) {
  MarkerScene scene;
  scene.on_forwarded(std::vector{marker("a", 1), marker("a", 2)}, 100);
  const auto before = scene.version();
  EXPECT_THAT(scene.changes(before).markers, IsEmpty());
  scene.on_forwarded(std::vector{marker("a", 2, 9), marker("a", 1, 0, MarkerAction::Delete),
                                 marker("absent", 1, 0, MarkerAction::Delete)},
                     101);
  const auto news = scene.changes(before);
  EXPECT_FALSE(news.whole);
  EXPECT_THAT(names(news), ElementsAre("a2"));
  EXPECT_THAT(news.gone, ElementsAre(Pair("a", 1)));
  EXPECT_EQ(news.version, scene.version());
}

TEST(MarkerScene, ListsAllAfterADeleteAllOrARestart) {
  MarkerScene scene;
  scene.on_forwarded(std::vector{marker("a", 1), marker("a", 2)}, 100);
  const auto before = scene.version();
  scene.on_forwarded(std::vector{marker("", 0, 0, MarkerAction::DeleteAll), marker("c", 1)}, 101);
  EXPECT_TRUE(scene.changes(before).whole);
  EXPECT_THAT(names(scene.changes(before)), ElementsAre("c1"));
  EXPECT_TRUE(scene.changes(scene.version() + 5000).whole) << "a version of an earlier process";
}

TEST(MarkerScene, IsEmptyInANewRun) {
  MarkerScene scene;
  scene.on_forwarded(std::vector{marker("a", 1)}, 100);
  const auto before = scene.version();
  scene.wipe(200);
  EXPECT_GT(scene.version(), before);
  EXPECT_TRUE(scene.changes(before).whole);
  EXPECT_THAT(scene.changes(before).markers, IsEmpty());
}

TEST(MarkerScene, OmitsAndCountsTheOldestOfTooMany) {
  MarkerScene scene;
  for (std::int32_t id = 0; id < 2003; ++id) scene.on_forwarded(std::vector{marker("a", id)}, 100 + id);
  const auto news = scene.changes(0);
  EXPECT_THAT(news.markers, SizeIs(MarkerScene::kMost));
  EXPECT_EQ(news.left_out, 3u);
  EXPECT_EQ(news.markers.front().marker.id, 3);
}

TEST(MarkerScene, OmitsTheOldestIfTheyAreTooLarge) {
  MarkerScene scene;
  icd::Marker line = marker("a", 0);
  line.type = static_cast<std::int32_t>(icd::MarkerType::LineStrip);
  for (int i = 0; i < 5000; ++i) line.points.push_back({i * 1.0, 0, 0});
  for (; line.id < 100; ++line.id) {
    scene.on_forwarded(std::vector{line}, 100 + line.id);
  }
  const auto news = scene.changes(0);
  std::size_t bytes = 0;
  for (const auto& row : news.markers) bytes += row.marker.size();
  EXPECT_LE(bytes, MarkerScene::kMostBytes);
  EXPECT_GT(news.markers.size(), 50u);
  EXPECT_EQ(news.left_out, 100 - news.markers.size());
  EXPECT_EQ(news.markers.back().marker.id, 99);
  const auto first = news.markers.front().marker.id;
  for (std::int32_t id = first; id < 100; ++id) scene.on_forwarded(std::vector{marker("a", id)}, 300);
  line.id = 0;
  scene.on_forwarded(std::vector{line}, 301);
  EXPECT_THAT(scene.changes(0).markers, SizeIs(101 - first)) << "smaller markers make room";
}

TEST(MarkerScene, LimitsTheNamesOfDeletedMarkers) {
  MarkerScene scene;
  const auto begun = (scene.on_forwarded(std::vector{marker("b", 0)}, 99), scene.version());
  for (char name = 'a'; name < 'z'; ++name) {
    const std::string longest(200'000, name);
    scene.on_forwarded(std::vector{marker(longest, 1), marker(longest, 1, 0, MarkerAction::Delete)}, 100);
  }
  EXPECT_TRUE(scene.changes(begun).whole) << "older changes are forgotten";
  EXPECT_THAT(names(scene.changes(0)), ElementsAre("b0"));
}

/// Applying all changes gives the scene at each version.
TEST(MarkerScene, HasChangesThatAddUpToTheScene) {
  std::mt19937 random(7);
  const auto below = [&random](std::uint32_t most) {
    return std::uniform_int_distribution<std::uint32_t>(0, most - 1)(random);
  };
  MarkerScene scene;
  using Shown = std::map<std::pair<std::string, std::int32_t>, double>;
  Shown followed;
  std::uint64_t known = 0;
  for (int step = 0; step < 4000; ++step) {
    for (std::uint32_t i = below(40); i > 0; --i) {
      const auto action = below(2000) == 0 ? MarkerAction::DeleteAll
                          : below(3) == 0  ? MarkerAction::Delete
                                           : MarkerAction::Add;
      scene.on_forwarded(std::vector{marker("n", static_cast<std::int32_t>(below(6000)), step, action)},
                         step / 10.0);
    }
    if (below(20) != 0) continue;
    const auto news = scene.changes(known);
    if (news.whole) followed.clear();
    for (const auto& key : news.gone) followed.erase(key);
    for (const auto& row : news.markers) {
      followed[{row.marker.ns, row.marker.id}] = row.marker.position.x;
    }
    known = news.version;
    Shown whole;
    for (const auto& row : scene.changes(0).markers) {
      whole[{row.marker.ns, row.marker.id}] = row.marker.position.x;
    }
    ASSERT_EQ(followed, whole) << "after step " << step;
    ASSERT_LE(whole.size(), MarkerScene::kMost);
  }
}

}  // namespace
}  // namespace adit::forward
