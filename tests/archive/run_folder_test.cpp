#include "archive/run_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "archive/a_run.hpp"
#include "host/folder.hpp"

namespace adit::archive {
namespace {

constexpr std::uint64_t kMost = std::uint64_t{2} << 20;

class RunFolderTest : public testing::Test {
 protected:
  Batch tiles(int from) {
    run.draw(8, from);
    Batch batch;
    for (int i = from; i < from + 8; ++i) {
      const TileKey key{run.easel.layer, {0, i % 100, 0}};
      const auto shown = run.easel.mosaic.tile(key.first, key.second, {});
      batch.tiles.push_back({key.first, key.second, shown.stamp, shown.tile});
    }
    return batch;
  }
  host::Folder folder;
  ARun run;
};

TEST_F(RunFolderTest, StaysWithinItsSizeAndKeepsTheNewest) {
  RunFolder files(folder.path(), run.head);
  std::uint64_t most = 0;
  for (int i = 0; i < 100; ++i) {
    const auto written = files.write(tiles(8 * i), kMost);
    ASSERT_TRUE(written) << written.error();
    most = std::max(most, written->bytes);
  }
  EXPECT_LT(most, kMost + kMost / 4);
  RunRecords told(picture::Mosaic::kBudget);
  EXPECT_TRUE(read_run(folder.path(), told, [] { return false; }));
  for (int i = 0; i < 100; ++i) {
    const picture::TileIndex at{0, i, 0};
    EXPECT_EQ(told.picture().tile(run.easel.layer, at, {}).tile->crc,
              run.easel.mosaic.tile(run.easel.layer, at, {}).tile->crc);
  }
  EXPECT_EQ(told.picture().tile(run.easel.layer, {0, 0, 0}, 1001).tile, nullptr)
      << "the earliest tile must be gone";
}

TEST_F(RunFolderTest, ContinuesTheFileAfterARestart) {
  for (int life = 0; life < 5; ++life)
    ASSERT_TRUE(RunFolder(folder.path(), run.head).write(tiles(8 * life), kMost));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    files += entry.is_regular_file();
  EXPECT_LT(files, 5U);
}

/// If the size is unknown, a repair after an error could cut the file.
TEST_F(RunFolderTest, AppendsNothingToAFileOfUnknownSize) {
  std::filesystem::create_symlink(folder / "map-00000001", folder / "map-00000001");
  const auto written = RunFolder(folder.path(), run.head).write(tiles(0), kMost);
  ASSERT_TRUE(written) << written.error();
  EXPECT_GT(written->bytes, std::size_t{900} << 10) << "the directory counts as full";
}

TEST_F(RunFolderTest, WritesTheHeadIntoAFileLeftEmptyByACrash) {
  std::ofstream(folder / "map-00000001");
  ASSERT_TRUE(RunFolder(folder.path(), run.head).write(tiles(0), kMost));
  RunRecords told(picture::Mosaic::kBudget);
  ASSERT_TRUE(read_run(folder.path(), told, [] { return false; }));
  ASSERT_TRUE(told.head());
  EXPECT_EQ(told.files().begin()->second, 1U);
}

TEST_F(RunFolderTest, ContinuesAfterFilesUnreadableAtFirst) {
  const std::string path = folder / "5";
  std::ofstream(path) << "no folder";
  RunFolder files(path, run.head);
  EXPECT_FALSE(files.write(tiles(0), kMost));
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  std::ofstream(path + "/map-00000003") << "x";
  const auto written = files.write(tiles(0), kMost);
  ASSERT_TRUE(written) << written.error();
  EXPECT_EQ(written->file, 3U);
}

TEST_F(RunFolderTest, ReportsAFileThatCannotBeRemoved) {
  std::filesystem::create_directory(folder / "map-00000001");
  ASSERT_TRUE(RunFolder(folder.path(), run.head).write(tiles(0), kMost));
  const auto written = RunFolder(folder.path(), run.head).write(tiles(8), 0);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().find("map-00000001"), std::string::npos) << written.error();
}

TEST_F(RunFolderTest, RemovesItsFirstFileButNotTheLast) {
  RunFolder files(folder.path(), run.head);
  std::uint64_t first = 0;
  for (int i = 0; first == 0; ++i) first = files.write(tiles(8 * i), kMost)->first_file;
  const auto before = files.bytes();
  files.remove_first(first);
  EXPECT_LT(files.bytes(), before);
  files.remove_first(first + 1);
  EXPECT_GT(files.bytes(), 0U);
}

}  // namespace
}  // namespace adit::archive
