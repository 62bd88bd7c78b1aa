#include <gmock/gmock.h>
#include <sys/fsuid.h>

#include <filesystem>

#include "archive/a_run.hpp"
#include "archive/run_folder.hpp"
#include "host/folder.hpp"
#include "host/service.hpp"

namespace adit::archive {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

class RunsFolderTest : public testing::Test {
 protected:
  std::string run(std::int64_t number, double began, std::size_t bytes, double clock_ahead = 0) {
    const Head head{.run = number, .began = began, .post = "here:1"};
    const std::string key = *runs.begin(head);
    RunFolder files(runs.folder_of(key), head);
    const api::RunRow facts{.run = number,
                            .post = "here:1",
                            .began = began,
                            .last = began + 10 + clock_ahead,
                            .stamp = began + 10};
    EXPECT_TRUE(files.write({.lines = std::string(bytes, 'x'), .facts = codec::write_file(facts)}, 1 << 20));
    return key;
  }
  std::vector<std::string> keys() const {
    std::vector<std::string> keys;
    for (const api::RunRow& row : runs.list().value().runs) keys.push_back(row.key);
    return keys;
  }
  host::Folder folder;
  RunsFolder runs{folder.path()};
};

TEST_F(RunsFolderTest, DeletesTheOldestRunsButNotThePresentOne) {
  run(1, 1000, 1000);
  run(2, 2000, 1000);
  run(3, 3000, 1000);
  EXPECT_THAT(keys(), ElementsAre("3", "2", "1"));
  runs.tidy(1'000'000, "1");
  EXPECT_EQ(keys().size(), 3U);
  runs.tidy(3000, "1");
  EXPECT_THAT(keys(), ElementsAre("3", "1"));
  runs.tidy(0, "1");
  EXPECT_THAT(keys(), ElementsAre("1"));
}

TEST_F(RunsFolderTest, SortsByStampNotByTimeOfDay) {
  run(1, 1000, 1000, 1e6);
  run(2, 2000, 1000);
  EXPECT_THAT(keys(), ElementsAre("2", "1"));
  runs.tidy(2000, "none");
  EXPECT_THAT(keys(), ElementsAre("2"));
}

TEST_F(RunsFolderTest, SortsRunsWithoutAStampByTimeOfDay) {
  run(1, 1000, 10);
  run(2, 2000, 10);
  const std::string facts = runs.folder_of("2") + "/facts.json";
  std::string text = *host::read_file(facts);
  text.erase(text.find("\"stamp\""), text.find("\"score\"") - text.find("\"stamp\""));
  std::ofstream(facts) << text;
  EXPECT_THAT(keys(), ElementsAre("2", "1"));
  EXPECT_EQ(runs.facts_of("2").value()->last, 2010);
}

TEST_F(RunsFolderTest, RecognizesARunWithDamagedFactsByItsFiles) {
  const std::string key = run(5, 1000, 10);
  std::ofstream(runs.folder_of(key) + "/facts.json") << "{\"version\": 1";
  const auto rows = runs.list().value().runs;
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].run, 5);
  EXPECT_EQ(rows[0].began, 1000);
  EXPECT_EQ(*runs.begin({.run = 5, .began = 1000, .post = "here:1"}), key);
}

/// A directory in the place of a file makes the file unreadable.
TEST_F(RunsFolderTest, RejectsAnUnreadableRunInsteadOfANewOne) {
  const std::string path = runs.folder_of(run(5, 1000, 10));
  for (const char* name : {"/facts.json", "/lines-00000001"}) {
    fs::remove(path + name);
    fs::create_directory(path + name);
  }
  const auto begun = runs.begin({.run = 5, .began = 1000, .post = "here:1"});
  ASSERT_FALSE(begun) << *begun;
  EXPECT_THAT(begun.error(), testing::HasSubstr(path));
  run(6, 1000, 10);
  EXPECT_THAT(keys(), ElementsAre("6"));
  EXPECT_THAT(runs.list()->unreadable, testing::HasSubstr(path));
}

TEST_F(RunsFolderTest, ReportsARunWhoseFilesCannotBeListed) {
  const std::string path = runs.folder_of(run(5, 1000, 10));
  for (const char* open : {"", "/runs", "/runs/5", "/runs/5/facts.json"})
    fs::permissions(folder.path() + open, fs::perms{0755});
  fs::permissions(path, fs::perms{0311});
  const int before = setfsuid(65534);  // root may list all directories
  const auto facts = runs.facts_of("5");
  setfsuid(before);
  fs::permissions(path, fs::perms{0700});
  ASSERT_FALSE(facts) << (*facts)->bytes;
  EXPECT_EQ(facts.error(), path + ": Permission denied");
}

TEST_F(RunsFolderTest, DoesNotTakeAnUnreadableRunForAnAbsentOne) {
  const std::string path = runs.folder_of(run(5, 1000, 10));
  fs::permissions(folder / "runs", fs::perms::none);
  const int before = setfsuid(65534);  // root may search all directories
  const auto exists = runs.has("5");
  const auto removed = runs.remove("5");
  const auto list = runs.list();
  setfsuid(before);
  fs::permissions(folder / "runs", fs::perms{0700});
  ASSERT_FALSE(exists) << *exists;
  EXPECT_EQ(exists.error(), path + ": Permission denied");
  EXPECT_EQ(removed.error(), exists.error());
  EXPECT_FALSE(list) << list->runs.size();
}

TEST_F(RunsFolderTest, DoesNotContinueADirectoryOfAnUnknownRun) {
  const std::string path = runs.folder_of(run(5, 1000, 10));
  for (const char* name : {"/facts.json", "/lines-00000001"}) std::ofstream(path + name) << "damaged";
  EXPECT_EQ(*runs.begin({.run = 5, .began = 1000, .post = "here:1"}), "5-2");
}

TEST_F(RunsFolderTest, CompletesARemovalAfterACrash) {
  fs::create_directories(folder / "runs/gone-7");
  std::ofstream(folder / "runs/gone-7/map-00000001") << "x";
  run(1, 1000, 10);
  runs.tidy(1'000'000, "1");
  EXPECT_FALSE(fs::exists(folder / "runs/gone-7"));
  EXPECT_THAT(keys(), ElementsAre("1"));
}

TEST_F(RunsFolderTest, RejectsAPathAsAKey) {
  for (const char* key : {"1", "12-2", "123456789"}) EXPECT_TRUE(RunsFolder::is_key(key)) << key;
  for (const char* key :
       {"", "..", "1/2", "a", "1-", "-1", "1-2-3", "gone-1", "1111111111111111111111111111111"})
    EXPECT_FALSE(RunsFolder::is_key(key)) << key;
}

}  // namespace
}  // namespace adit::archive
