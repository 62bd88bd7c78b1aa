#include <gtest/gtest.h>

#include "rehearsal/robots/explorer.hpp"

namespace adit::robots {
namespace {

using Scene = std::map<std::pair<std::string, int>, Vector3>;

void replay(const std::vector<Marker>& changes, Scene& scene) {
  for (const Marker& marker : changes) {
    if (marker.action == Marker::Delete) {
      EXPECT_EQ(scene.erase({marker.ns, marker.id}), 1u) << "deleted what was not there: " << marker.ns;
    } else {
      scene[{marker.ns, marker.id}] = marker.position;
    }
  }
}

TEST(MarkerScene, IsCompleteByItsChanges) {
  MarkerScene scene("r1");
  Scene seen;
  for (int second = 0; second < 300; ++second) {
    scene.pass({1.0 * second, 0, 0}, 1.0 * second, second);
    if (second % 50 == 10) scene.candidate("Rope", {1.0 * second, 2, 0}, second);
    if (second % 2 == 0) replay(scene.take_changes(), seen);
  }
  replay(scene.take_changes(), seen);
  std::map<std::string, int> of_ns;
  for (const auto& [key, position] : seen) ++of_ns[key.first];
  EXPECT_EQ(of_ns["r1/path"], 60) << "older nodes are deleted";
  EXPECT_EQ(of_ns["r1/comms"], 25);
  EXPECT_EQ(of_ns["r1/artifact"], 0) << "candidates are deleted in the end";
}

TEST(MarkerScene, HasNoChangesIfNothingChanged) {
  MarkerScene scene("r1");
  scene.pass({}, 0, 0);
  EXPECT_EQ(scene.take_changes().size(), 4u) << "its way, its shape, a node of the path and one for comms";
  EXPECT_TRUE(scene.take_changes().empty());
}

TEST(MarkerScene, RepeatsTheWholeSceneNowAndThen) {
  MarkerScene scene("r1");
  scene.pass({}, 0, 0);
  int times = 0;
  for (int i = 0; i < 20; ++i) times += scene.take_changes().size() >= 2 ? 1 : 0;
  EXPECT_EQ(times, 3) << "once as news, and at the tenth and the twentieth call";
}

}  // namespace
}  // namespace adit::robots
