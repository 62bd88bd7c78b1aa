// A run's files after a power cut, on a bad card or after edits: intact parts are used.
#include <gtest/gtest.h>

#include <random>

#include "archive/a_run.hpp"
#include "archive/run_records.hpp"

namespace adit::archive {
namespace {

class Damage : public testing::Test {
 protected:
  void SetUp() override {
    run.draw(4);
    file = record_of(run.head);
    for (const picture::LayerView& layer : run.easel.mosaic.layers()) {
      file += record_of(layer);
      for (const picture::TileView& tile : layer.tiles) {
        const auto shown = run.easel.mosaic.tile(layer.layer, tile.at, {});
        file += record_of(TileState{layer.layer, tile.at, shown.stamp, shown.tile});
        ++tiles;
      }
    }
    for (int i = 0; i < 5; ++i) {
      file += record_of(Sample{.at = 1000.0 + i, .map_ages = {{"ugv1", 1}}});
      file += record_of(api::AttentionStep{1000.0 + i, true, "it came"});
    }
    file += record_of(run.tracks[0]);
  }
  /// Reads the file and counts the restored tiles. Each tile is unchanged or missing.
  std::size_t sound(const std::string& bytes) {
    RunRecords told(picture::Mosaic::kBudget);
    told.add_file(bytes, 1);
    std::size_t count = 0;
    for (const auto& [key, of] : told.files()) {
      const auto is = told.picture().tile(key.first, key.second, {}).tile;
      const auto was = run.easel.mosaic.tile(key.first, key.second, {}).tile;
      EXPECT_TRUE(is && was && is->crc == was->crc && is->deflated == was->deflated);
      ++count;
    }
    (void)told.tracks();
    (void)told.samples().history_after(0);
    return count;
  }
  ARun run;
  std::string file;
  std::size_t tiles = 0;
};

TEST_F(Damage, OfOneBitLosesAtMostOneRecord) {
  ASSERT_EQ(sound(file), tiles);
  const std::size_t head = record_of(run.head).size();
  for (std::size_t at = head; at < file.size(); at += 37) {
    std::string damaged = file;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (at % 8)));
    ASSERT_GE(sound(damaged), tiles - 1) << "byte " << at;
  }
}

TEST_F(Damage, OfTheHeadLosesItsTiles) {
  std::string damaged = file;
  damaged[20] ^= 1;
  EXPECT_EQ(sound(damaged), 0U);
  RunRecords told(picture::Mosaic::kBudget);
  told.add_file(file, 1);
  told.add_file(damaged, 2);  // a later file of the same run
  EXPECT_EQ(told.files().size(), tiles);
}

TEST_F(Damage, ByACutLeavesEarlierRecords) {
  std::size_t before = 0;
  for (std::size_t cut = 0; cut <= file.size(); cut += 101) {
    const std::size_t now = sound(file.substr(0, cut));
    ASSERT_GE(now, before) << "cut at " << cut;
    before = now;
  }
}

TEST_F(Damage, IsCountedWithoutATornEnd) {
  RunRecords torn(0), damaged(0);
  torn.add_file(file.substr(0, file.size() - 1), 1);
  EXPECT_EQ(torn.damaged_records(), 0u);
  file.back() ^= 1;
  damaged.add_file(file + file, 1);
  EXPECT_EQ(damaged.damaged_records(), 2u) << "including the one at the end";
}

TEST_F(Damage, EverywhereDoesNotCrash) {
  std::mt19937 random{5};
  for (int i = 0; i < 300; ++i) {
    std::string damaged = file;
    for (int n = 0; n < 200; ++n) damaged[random() % damaged.size()] = static_cast<char>(random());
    (void)sound(damaged);
    std::string noise(5000, '\0');
    for (char& c : noise) c = static_cast<char>(random());
    (void)sound(noise);
  }
}

TEST_F(Damage, WithARightChecksumIsRejected) {
  for (const std::string_view bytes : {std::string_view("no zlib at all"), std::string_view("x")}) {
    auto lie = std::make_shared<picture::PackedTile>();
    lie->deflated.assign(bytes.begin(), bytes.end());
    const std::string record = record_of(TileState{{"ugv1"}, {0, 9, 9}, 1, lie});
    EXPECT_EQ(sound(file + record), tiles);
  }
}

TEST_F(Damage, RecordsOfAnotherRunAreIgnored) {
  RunRecords told(picture::Mosaic::kBudget);
  told.add_file(record_of(Head{.run = 9, .began = 1}), 1);
  told.add_file(file, 2);
  EXPECT_TRUE(told.files().empty());
}

// A write that failed halfway writes its lines again.
TEST_F(Damage, AClockStepWrittenTwiceCountsOnce) {
  constexpr std::uint64_t kLines = 0;
  const std::string step = record_of(Step{.seconds = 50, .when = 7});
  const std::string later = record_of(Step{.seconds = 50, .when = 8});
  RunRecords told(picture::Mosaic::kBudget);
  told.add_file(file + step + step, kLines);
  EXPECT_EQ(told.tracks()[0].poses[0].at, 1051);
  told.add_file(record_of(run.head) + step + later, kLines);
  EXPECT_EQ(told.tracks()[0].poses[0].at, 1101);
  told.add_file(record_of(run.head) + step + later, kLines);
  EXPECT_EQ(told.tracks()[0].poses[0].at, 1101) << "both were in the failed write";
}

}  // namespace
}  // namespace adit::archive
