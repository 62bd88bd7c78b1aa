#include "gateway/spool.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "codec/body_decoder.hpp"
#include "codec/read.hpp"

namespace adit::gateway {
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

icd::StateUpdate state() {
  return {.header = {.stamp = 7.5}, .poses = {{*icd::RobotName::parse("r2"), {}}}};
}

icd::MarkersUpdate markers() {
  icd::Marker marker;
  marker.ns = "path";
  marker.color.a = 1;
  return {.markers = {marker}};
}

TEST_F(SpoolTest, GivesBackWhatItKeptByNumberUntilItIsForgotten) {
  const Spool spool(folder_ / "waiting");
  for (const std::uint64_t number : {9, 100'000'000, 10})
    spool.keep(number, grid("r1", static_cast<std::uint8_t>(number % 100)));
  spool.forget(10);
  spool.forget(11);
  const auto kept = Spool(folder_ / "waiting").read({});
  ASSERT_EQ(kept.maps.size(), 2u);
  EXPECT_EQ(kept.maps[0].first, 9u);
  EXPECT_EQ(kept.maps[0].second, grid("r1", 9));
  EXPECT_EQ(kept.maps[1].first, 100'000'000u);
}

TEST_F(SpoolTest, KeepsTheLastStateAndMarkersAndForgetsEmptyOnes) {
  const Spool spool(folder_);
  spool.keep(state(), markers());
  EXPECT_EQ(spool.read({}).state, state());
  EXPECT_EQ(spool.read({}).markers, markers());
  spool.keep({}, markers());
  EXPECT_TRUE(spool.read({}).state.poses.empty());
  EXPECT_EQ(spool.read({}).markers, markers());
  spool.keep(icd::StateUpdate{}, icd::MarkersUpdate{});
  EXPECT_TRUE(spool.read({}).markers.markers.empty());
}

TEST_F(SpoolTest, IsReadableByNobodyElse) {
  const Spool spool(folder_ / "waiting");
  struct stat status{};
  ASSERT_EQ(::stat((folder_ / "waiting").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0700u);
}

TEST_F(SpoolTest, SetsAsideWhatItCannotReadAndGoesOn) {
  const Spool spool(folder_);
  spool.keep(1, grid("r1", 1));
  spool.keep(2, grid("r2", 2));
  std::ofstream(folder_ / "map-00000001.cbor") << "not a map";
  const auto kept = spool.read({});
  ASSERT_EQ(kept.maps.size(), 1u);
  EXPECT_EQ(kept.maps[0].second.name->text(), "r2");
  EXPECT_TRUE(fs::exists(folder_ / "map-00000001.cbor.damaged"));
}

TEST_F(SpoolTest, TakesNothingForAMapThatWasNotWrittenToItsEnd) {
  const Spool spool(folder_);
  std::ofstream(folder_ / "map-00000003.cbor.part") << "half";
  std::ofstream(folder_ / "map-x.cbor") << "no number";
  EXPECT_TRUE(spool.read({}).maps.empty());
}

TEST_F(SpoolTest, GoesOnWhereItsFolderCannotBeWritten) {
  std::ofstream(folder_ / "file") << "";
  const Spool spool(folder_ / "file" / "waiting");
  spool.keep(1, grid("r1", 1));
  EXPECT_TRUE(spool.read({}).maps.empty());
}

}  // namespace
}  // namespace adit::gateway
