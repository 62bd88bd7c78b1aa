#include <gmock/gmock.h>

#include "archive/a_run.hpp"
#include "archive/run_records.hpp"

namespace adit::archive {
namespace {

using picture::TileIndex;

std::vector<TileIndex> places(const std::vector<TileKey>& keys) {
  std::vector<TileIndex> places;
  for (const auto& [layer, at] : keys) places.push_back(at);
  return places;
}

class DueTilesTest : public testing::Test {
 protected:
  void write_all(double now, std::uint64_t write = 1, std::optional<std::uint64_t> file = 1) {
    for (const TileKey& key : due.at(now)) due.record_write(key, write, now);
    due.on_written(write, file);
  }
  ARun run;
  DueTiles due;
};

TEST_F(DueTilesTest, AreTheChangedOnesOnceEach) {
  run.draw(1);
  due.mark_changed(run.easel.mosaic);
  EXPECT_EQ(due.at(1000).size(), 3U) << "one of each level";
  write_all(1000);
  EXPECT_TRUE(due.at(2000).empty());
  run.draw(1, 1);
  due.mark_changed(run.easel.mosaic);
  EXPECT_THAT(places(due.at(2000)), testing::Contains(TileIndex{0, 1, 0}));
  EXPECT_THAT(places(due.at(2000)), testing::Not(testing::Contains(TileIndex{0, 0, 0})));
}

TEST_F(DueTilesTest, OfCoarserLevelsAreDueLater) {
  run.draw(1);
  due.mark_changed(run.easel.mosaic);
  write_all(1000);
  run.easel.draw(picture::grid_at(0, 0, 1, 0.25, {100}));
  run.easel.draw(picture::grid_at(0, 0, 1, 0.25, {0}));
  due.mark_changed(run.easel.mosaic);
  EXPECT_TRUE(due.at(1003).empty());
  EXPECT_THAT(places(due.at(1005)), testing::ElementsAre(TileIndex{0, 0, 0}));
  EXPECT_THAT(places(due.at(1100)), testing::Contains(TileIndex{1, 0, 0}));
}

TEST_F(DueTilesTest, NeverWrittenComeFirstThenTheOldest) {
  run.draw(3);
  due.mark_changed(run.easel.mosaic);
  for (const auto& [at, when] : {std::pair(1, 1000.0), std::pair(0, 1010.0)})
    due.record_write({run.easel.layer, {0, at, 0}}, 1, when);
  due.on_written(1, 1);
  for (int i = 0; i < 3; ++i) run.easel.draw(picture::grid_at(64.0 * i, 0, 1, 0.25, {100}));
  due.mark_changed(run.easel.mosaic);
  std::vector<TileIndex> finest;
  for (const TileIndex& at : places(due.at(1500))) {
    if (at.level == 0) finest.push_back(at);
  }
  EXPECT_THAT(finest, testing::ElementsAre(TileIndex{0, 2, 0}, TileIndex{0, 1, 0}, TileIndex{0, 0, 0}));
}

TEST_F(DueTilesTest, AreDueAgainAfterAFailedWrite) {
  run.draw(1);
  due.mark_changed(run.easel.mosaic);
  write_all(1000, 1, std::nullopt);
  EXPECT_EQ(due.at(2000).size(), 3U);
}

TEST_F(DueTilesTest, ChangedDuringTheWriteAreDueAgain) {
  run.draw(1);
  due.mark_changed(run.easel.mosaic);
  for (const TileKey& key : due.at(1000)) due.record_write(key, 1, 1000);
  run.easel.draw(picture::grid_at(0, 0, 1, 0.25, {100}));
  run.easel.draw(picture::grid_at(0, 0, 1, 0.25, {0}));
  due.mark_changed(run.easel.mosaic);
  due.on_written(1, 1);
  EXPECT_THAT(places(due.at(2000)), testing::Contains(TileIndex{0, 0, 0}));
}

TEST_F(DueTilesTest, OfAFileToDeleteAreWrittenAgainFirst) {
  run.draw(1);
  due.mark_changed(run.easel.mosaic);
  write_all(1000, 1, 1);
  EXPECT_TRUE(due.release_file(2));
  EXPECT_FALSE(due.release_file(1));
  EXPECT_EQ(due.at(2000).size(), 3U);
  write_all(2000, 2, 2);
  EXPECT_TRUE(due.release_file(1)) << "the file has no newest tile";
}

TEST_F(DueTilesTest, WrittenBeforeARestartAreNotDue) {
  run.draw(2);
  std::map<TileKey, std::uint64_t> files;
  files[{run.easel.layer, {0, 0, 0}}] = 4;
  due.begin(run.easel.mosaic, files);
  EXPECT_THAT(places(due.at(5000)), testing::Not(testing::Contains(TileIndex{0, 0, 0})));
  EXPECT_THAT(places(due.at(5000)), testing::Contains(TileIndex{0, 1, 0}));
  EXPECT_FALSE(due.release_file(4));
}

TEST_F(DueTilesTest, OfAnEarlierRunAreDropped) {
  run.draw(1);
  run.easel.mosaic.wipe(++run.easel.now);
  due.begin(run.easel.mosaic, {});
  EXPECT_TRUE(due.at(5000).empty());
}

}  // namespace
}  // namespace adit::archive
