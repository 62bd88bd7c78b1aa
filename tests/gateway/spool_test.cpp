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

TEST_F(SpoolTest, GivesBackWhatWaitedInItsOrderAndOnce) {
  const Spool spool(folder_ / "waiting");
  Unsent unsent;
  for (std::uint8_t i = 0; i < 12; ++i) unsent.maps.push_back(grid("r1", i));
  unsent.state = {.header = {.stamp = 7.5}, .poses = {{*icd::RobotName::parse("r2"), {}}}};
  icd::Marker marker;
  marker.ns = "path";
  marker.color.a = 1;
  unsent.markers.markers.push_back(marker);
  spool.save(unsent);

  const Unsent found = spool.take({});
  EXPECT_EQ(found.maps, unsent.maps);
  EXPECT_EQ(found.state, unsent.state);
  EXPECT_EQ(found.markers, unsent.markers);
  EXPECT_TRUE(spool.take({}).maps.empty());
  EXPECT_TRUE(spool.take({}).state.poses.empty());
}

TEST_F(SpoolTest, IsReadableByNobodyElse) {
  Spool(folder_ / "waiting").save({.maps = {grid("r1", 1)}, .state = {}, .markers = {}});
  struct stat status{};
  ASSERT_EQ(::stat((folder_ / "waiting").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0700u);
}

TEST_F(SpoolTest, SetsAsideWhatItCannotReadAndGoesOn) {
  const Spool spool(folder_);
  spool.save({.maps = {grid("r1", 1), grid("r2", 2)}, .state = {}, .markers = {}});
  std::ofstream(folder_ / "map-00000000.cbor") << "not a map";
  const Unsent found = spool.take({});
  ASSERT_EQ(found.maps.size(), 1u);
  EXPECT_EQ(found.maps[0].name->text(), "r2");
  EXPECT_TRUE(fs::exists(folder_ / "map-00000000.cbor.damaged"));
}

TEST_F(SpoolTest, FindsNothingWhereThereIsNoFolder) {
  EXPECT_TRUE(Spool(folder_ / "absent").take({}).maps.empty());
}

}  // namespace
}  // namespace adit::gateway
