#include "spool/spool.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "codec/body_decoder.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"
#include "spool/bytes_read.hpp"
#include "spool/kept_message.hpp"
#include "spool/messages.hpp"

namespace adit::spool {
namespace {

namespace fs = std::filesystem;

class SpoolTest : public testing::Test {
 protected:
  SpoolTest() {
    std::string pattern = fs::temp_directory_path() / "adit-spool-XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
  }
  ~SpoolTest() override { fs::remove_all(folder_); }

  fs::path folder_;
};

icd::MapUpdate grid(const char* name, std::uint8_t value) {
  const std::string body =
      std::string(R"({"type":"OccupancyGrid","name":")") + name +
      R"(","msg":{"header":{"stamp":5},"info":{"resolution":0.1,"width":2,"height":2,"origin":)"
      R"({"position":{"x":1,"y":2,"z":3},"orientation":{"x":0,"y":0,"z":0,"w":1}}},"data":[0,100,-1,)" +
      std::to_string(value) + "]}}";
  auto document =
      codec::decode({codec::Format::Json, codec::ContentCoding::Identity}, codec::Split::MapData, body);
  return codec::read_map_update(std::move(*document), {}).value();
}

TEST_F(SpoolTest, StoresMapsInOrderUntilForgotten) {
  Spool spool(folder_ / "waiting");
  for (const std::uint64_t number : {9, 100'000'000, 10})
    ASSERT_TRUE(spool.keep(number, grid("r1", static_cast<std::uint8_t>(number % 100)), 0));
  spool.forget(10);
  spool.forget(11);
  const auto kept = Spool(folder_ / "waiting").read();
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].number, 9u);
  EXPECT_EQ(kept[0].map, grid("r1", 9));
  EXPECT_EQ(kept[1].number, 100'000'000u);
}

TEST_F(SpoolTest, StoresTheBoundsOfAGridUntilItIsForgotten) {
  Spool spool(folder_);
  const icd::MapUpdate map = grid("r1", 1);
  const auto& own = std::get<icd::OccupancyGrid>(map.msg);
  auto older = own;
  older.origin.position.x += 0.03;
  older.origin.position.z -= 0.01;
  const auto bounds = icd::joint_bounds(icd::GridBounds::from_grid(own), icd::GridBounds::from_grid(older));
  for (const std::uint64_t number : {1, 2, 3, 4}) ASSERT_TRUE(spool.keep(number, map, 0));
  for (const std::uint64_t number : {1, 2, 3}) ASSERT_TRUE(spool.keep_bounds(number, bounds));
  auto kept = spool.read();
  ASSERT_EQ(kept.size(), 4U);
  EXPECT_EQ(kept[0].bounds, bounds) << "to the last bit";
  EXPECT_FALSE(kept[3].bounds);

  spool.forget(1);
  spool.set_aside(2, "a test");
  for (const std::uint64_t number : {1, 2}) ASSERT_TRUE(spool.keep(number, map, 0));
  EXPECT_FALSE(spool.read()[0].bounds) << "those of an earlier map of that number";
  EXPECT_FALSE(spool.read()[1].bounds);
  for (const char* damaged :
       {"", "[1,2,3,4,5,6]", "[1,2,3,4,5,6,\"\"]", "{}", "[1,2,3,4,5,6,7", "[0,0,0,0,0,0,1e999]"}) {
    std::ofstream(folder_ / "map-00000003.bounds") << damaged;
    kept = spool.read();
    ASSERT_EQ(kept.size(), 4U) << damaged;
    EXPECT_FALSE(kept[2].bounds) << damaged;
  }
  std::ofstream(folder_ / "map-00000003.bounds") << "[5,5,5,-5,-5,-5,-5]";
  EXPECT_EQ(spool.read()[2].bounds, icd::GridBounds::from_grid(own)) << "never smaller than the grid";
}

TEST_F(SpoolTest, RejectsMapsUntilItsDirectoryWasRead) {
  const fs::path folder = folder_ / "waiting";
  std::ofstream(folder) << "no folder";
  Spool spool(folder);
  EXPECT_TRUE(spool.read().empty());
  fs::remove(folder);
  const auto kept = spool.keep(1, grid("r1", 1), 0);
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().sentence,
            "Adit cannot store this map: " + folder.string() + ": Not a directory; send it again later");
  EXPECT_TRUE(spool.read().empty());
  EXPECT_TRUE(spool.keep(1, grid("r1", 1), 0)) << "the directory is readable";
}

TEST_F(SpoolTest, StartReadsNoDataOfMaps) {
  Spool spool(folder_);
  for (std::uint64_t number = 1; number <= 3; ++number)
    ASSERT_TRUE(spool.keep(number, cloud(1'000'000), 0));  // of 12 MB
  ASSERT_TRUE(spool.keep(4, grid("r1", 1), 0));
  std::fstream(folder_ / "map-00000004.cbor", std::ios::in | std::ios::out | std::ios::binary).seekp(40)
      << "?";
  const auto before = BytesRead::of(folder_);
  const auto kept = spool.read();
  const auto after = BytesRead::of(folder_);
  EXPECT_LT(after.by_calls - before.by_calls, 1'000'000U);
  EXPECT_GT(after.in_mappings, before.in_mappings) << "its two ends";
  EXPECT_LT(after.in_mappings - before.in_mappings, 1'000'000U);
  ASSERT_EQ(kept.size(), 4U);
  EXPECT_EQ(kept[0].map, cloud(1'000'000));
  EXPECT_TRUE(codec::check_data(kept[0].map));
  EXPECT_FALSE(codec::check_data(kept[3].map)) << "reading must find the damage";
}

TEST_F(SpoolTest, RenamesAMapOfAWrongLength) {
  Spool spool(folder_);
  for (const std::uint64_t number : {1, 2, 3}) ASSERT_TRUE(spool.keep(number, cloud(10), 0));
  fs::resize_file(folder_ / "map-00000001.cbor", 100);
  fs::resize_file(folder_ / "map-00000002.cbor", fs::file_size(folder_ / "map-00000002.cbor") + 1);
  EXPECT_EQ(spool.read().size(), 1U);
  EXPECT_THAT(spool.put_aside(), testing::HasSubstr("map-00000001.cbor: the file is cut short; "));
  EXPECT_TRUE(fs::exists(folder_ / "map-00000001.cbor.damaged"));
  EXPECT_TRUE(fs::exists(folder_ / "map-00000002.cbor.damaged"));
}

/// Processes that end while they pack maps, each in the directory that the one before has left.
class EndedSpool : public SpoolTest {
 protected:
  EndedSpool() {
    Spool spool(folder());
    for (const std::uint64_t number : {1, 2, 3}) EXPECT_TRUE(spool.keep(number, grid("r1", 1), 0));
  }
  std::string folder() const { return folder_ / "waiting"; }
  /// A process that does `work` and is killed. Returns the ends that it has read, by the map's place.
  template <class Work>
  std::vector<Spool::EndCounts> kill_after(Work work) {
    std::vector<Spool::EndCounts> ends;
    {
      Spool spool(folder());
      for (const auto& kept : spool.read()) ends.push_back(kept.ends);
      EXPECT_EQ(spool.put_aside(), "");
      work(spool);
      fs::copy(folder(), folder() + ".killed");
    }
    fs::remove_all(folder());
    fs::rename(folder() + ".killed", folder());
    return ends;
  }
  std::vector<Spool::EndCounts> kill_in(const std::vector<std::uint64_t>& numbers, bool by_fault = false) {
    return kill_after([&](Spool& spool) {
      spool.begin_work(numbers);
      if (by_fault) spool.record_overrun();
    });
  }
};

TEST_F(EndedSpool, NeverLosesAMapByKills) {
  for (int i = 0; i < 10; ++i) EXPECT_EQ(kill_in({1, 2}).size(), 3u) << i;
  const auto ends = kill_in({});
  EXPECT_EQ(ends[0], (Spool::EndCounts{.faults = 0, .others = 10}));
  EXPECT_EQ(ends[2], Spool::EndCounts());
}

TEST_F(EndedSpool, CountsFaultsApart) {
  kill_in({1, 2});
  kill_in({1}, /*by_fault=*/true);
  kill_in({3});
  kill_in({1}, /*by_fault=*/true);
  const auto ends = kill_in({});
  EXPECT_EQ(ends[0], (Spool::EndCounts{.faults = 2, .others = 1}));
  EXPECT_EQ(ends[1], (Spool::EndCounts{.faults = 0, .others = 1}));
  EXPECT_EQ(ends[2], (Spool::EndCounts{.faults = 0, .others = 1}));
}

TEST_F(EndedSpool, CountsNoEndAfterTheWork) {
  kill_in({1, 2}, /*by_fault=*/true);
  kill_after([](Spool& spool) {
    spool.begin_work({1});
    spool.record_overrun();
    spool.end_work(/*are_packed=*/true);
    spool.begin_work({2});
    spool.end_work(/*are_packed=*/false);
  });
  {
    Spool orderly(folder());
    (void)orderly.read();
    orderly.begin_work({3});
  }
  const auto ends = kill_in({});
  EXPECT_EQ(ends[0], Spool::EndCounts()) << "it was packed since";
  EXPECT_EQ(ends[1], (Spool::EndCounts{.faults = 1, .others = 0}));
  EXPECT_EQ(ends[2], Spool::EndCounts());
}

TEST_F(EndedSpool, ForgetsTheEndsOfAMapThatIsGone) {
  kill_in({1, 2});
  kill_after([&](Spool& spool) {
    spool.forget_ends(std::vector<std::uint64_t>{1});
    EXPECT_TRUE(fs::exists(spool.work_file()));
    spool.forget_ends(std::vector<std::uint64_t>{2});
    EXPECT_FALSE(fs::exists(spool.work_file()));
  });
}

TEST_F(EndedSpool, RemembersTheEndsOfAMapUnderAnotherNumber) {
  kill_after([](Spool& spool) { spool.remember(2, {.faults = 3, .others = 0}); });
  const auto ends = kill_after([](Spool& spool) {
    spool.forget(2);
    ASSERT_TRUE(spool.keep(4, grid("r1", 1), 0));
  });
  EXPECT_EQ(ends[1], (Spool::EndCounts{.faults = 3, .others = 0}));
  kill_after([](Spool& spool) { ASSERT_TRUE(spool.keep(2, grid("r1", 1), 0)); });
  EXPECT_EQ(kill_in({})[1], Spool::EndCounts()) << "another map, of a later process";
}

TEST_F(SpoolTest, IsPrivate) {
  Spool spool(folder_ / "waiting");
  struct stat status{};
  ASSERT_EQ(::stat((folder_ / "waiting").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0700u);
}

TEST_F(SpoolTest, RenamesADamagedMapAndContinues) {
  Spool spool(folder_);
  ASSERT_TRUE(spool.keep(1, grid("r1", 1), 0));
  ASSERT_TRUE(spool.keep(2, grid("r2", 2), 0));
  std::ofstream(folder_ / "map-00000001.cbor") << "not a map";
  const auto kept = spool.read();
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].map.name->text(), "r2");
  EXPECT_TRUE(fs::exists(folder_ / "map-00000001.cbor.damaged"));
}

TEST_F(SpoolTest, PutsAMapAsideThatCanNeverBeReadIfOthersCan) {
  Spool spool(folder_);
  ASSERT_TRUE(spool.keep(2, grid("r2", 2), 0));
  fs::create_directory(folder_ / "map-00000001.cbor");
  const auto kept = spool.read();
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].number, 2u);
  EXPECT_EQ(spool.trouble(), "");
  const std::string file = (folder_ / "map-00000001.cbor").string();
  EXPECT_EQ(spool.put_aside(), file + ": cannot read " + file + ": is not a regular file");
  EXPECT_TRUE(fs::exists(file + ".damaged"));
  EXPECT_TRUE(spool.keep(3, grid("r1", 1), 0));
}

/// While it exists, the process can map only 4 MB more.
class ScarceAddresses {
 public:
  ScarceAddresses() {
    getrlimit(RLIMIT_AS, &before_);
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlimit scarce{pages * static_cast<rlim_t>(::getpagesize()) + 4'000'000, before_.rlim_max};
    setrlimit(RLIMIT_AS, &scarce);
  }
  ~ScarceAddresses() { setrlimit(RLIMIT_AS, &before_); }
  ScarceAddresses(const ScarceAddresses&) = delete;
  ScarceAddresses& operator=(const ScarceAddresses&) = delete;

 private:
  rlimit before_{};
};

TEST_F(SpoolTest, KeepsAllFilesIfOneCannotBeReadNow) {
  ASSERT_TRUE(Spool(folder_).keep(1, cloud(1'500'000), 0));
  ASSERT_TRUE(Spool(folder_).keep(2, grid("r2", 2), 0));
  fs::create_directory(folder_ / "map-00000003.cbor");
  Spool spool(folder_);
  {
    const ScarceAddresses scarce;
    EXPECT_TRUE(spool.read().empty());
  }
  EXPECT_THAT(spool.trouble(), testing::EndsWith("map-00000001.cbor: Cannot allocate memory"));
  EXPECT_EQ(spool.put_aside(), "");
  EXPECT_EQ(Spool(folder_).read().size(), 2u);
}

TEST_F(SpoolTest, KeepsAnUnreadableFileAndRejectsMaps) {
  Spool spool(folder_);
  fs::create_directory(folder_ / "map-00000001.cbor");
  EXPECT_TRUE(spool.read().empty());
  EXPECT_FALSE(can_be_read(folder_));
  EXPECT_TRUE(fs::exists(folder_ / "map-00000001.cbor"));
  const std::string why =
      "cannot read " + (folder_ / "map-00000001.cbor").string() + ": is not a regular file";
  EXPECT_EQ(spool.trouble(), why);
  const auto kept = spool.keep(1, grid("r1", 1), 0);
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().status, icd::Status::ServiceUnavailable);
  EXPECT_EQ(kept.error().sentence, "Adit cannot store this map: " + why + "; send it again later");
  fs::remove(folder_ / "map-00000001.cbor");
  EXPECT_TRUE(can_be_read(folder_));
  EXPECT_TRUE(can_be_read(folder_ / "none"));
  EXPECT_EQ(Spool(folder_).trouble(), "");
}

TEST_F(SpoolTest, IgnoresPartialAndForeignFiles) {
  Spool spool(folder_);
  std::ofstream(folder_ / "map-00000003.cbor.part") << "half";
  std::ofstream(folder_ / "map-x.cbor") << "no number";
  EXPECT_TRUE(spool.read().empty());
}

TEST_F(SpoolTest, StoredMapUsesItsFileEvenOnceForgotten) {
  Spool spool(folder_);
  const icd::MapUpdate whole = cloud(40'000);
  const auto kept = spool.keep(7, whole, 0);
  ASSERT_TRUE(kept) << kept.error().sentence;
  EXPECT_EQ(*kept, whole);
  EXPECT_NE(kept->data.bytes.chunks()[0]->data(), whole.data.bytes.chunks()[0]->data());
  EXPECT_EQ(kept->data.bytes.chunks()[0].owner(), kept->data.bytes.chunks()[1].owner()) << "one mapping";
  const auto again = Spool(folder_).read();
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].map, whole);
  EXPECT_EQ(again[0].map.data.bytes.chunks()[0].owner(), again[0].map.data.bytes.chunks()[1].owner())
      << "in the same file, not beside it";
  spool.forget(7);
  EXPECT_TRUE(fs::is_empty(folder_));
  EXPECT_EQ(*kept, whole);
}

TEST_F(SpoolTest, StoresACloudWithoutPoints) {
  Spool spool(folder_);
  const auto kept = spool.keep(1, cloud(0), 0);
  ASSERT_TRUE(kept);
  EXPECT_EQ(*kept, cloud(0));
}

TEST_F(SpoolTest, RejectsAMapWithoutRoomAndLeavesNoFile) {
  Spool spool(folder_);
  const auto kept = spool.keep(1, cloud(1000), std::uint64_t{1} << 62);
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().status, icd::Status::ServiceUnavailable);
  EXPECT_NE(kept.error().sentence.find("room"), std::string::npos) << kept.error().sentence;
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(SpoolTest, LeavesRoomForOtherFiles) {
  struct statvfs room{};
  ASSERT_EQ(::statvfs(folder_.c_str(), &room), 0);
  const std::uint64_t left = room.f_bavail * room.f_frsize, quarter = room.f_blocks * room.f_frsize / 4;
  const std::uint64_t all_but_half_of_theirs = left - std::min(left, quarter) / 2;
  EXPECT_TRUE(Spool(folder_).has_room(all_but_half_of_theirs));
  EXPECT_TRUE(Spool(folder_).keep(1, cloud(10), all_but_half_of_theirs));
  Spool polite(folder_, std::uint64_t{1} << 62);
  EXPECT_FALSE(polite.has_room(all_but_half_of_theirs));
  EXPECT_FALSE(polite.keep(2, cloud(10), all_but_half_of_theirs));
  if (left > quarter + quarter / 4) {
    EXPECT_TRUE(polite.keep(3, cloud(10), 0)) << "a quarter, and no more";
  }
}

TEST_F(SpoolTest, RemovesPartialFiles) {
  std::ofstream(folder_ / "map-00000003.cbor.part") << "half";
  Spool(folder_).read();
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(SpoolTest, RejectsMapsIfItsDirectoryIsUnwritable) {
  std::ofstream(folder_ / "file") << "";
  Spool spool(folder_ / "file" / "waiting");
  EXPECT_NE(spool.trouble(), "");
  const auto kept = spool.keep(1, grid("r1", 1), 0);
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().status, icd::Status::ServiceUnavailable);
  EXPECT_TRUE(spool.read().empty());
  EXPECT_EQ(Spool(folder_ / "waiting").trouble(), "");
}

}  // namespace
}  // namespace adit::spool
