// Stored maps with damaged data. Packing detects the damage.
#include <filesystem>
#include <fstream>

#include "codec/gzip.hpp"
#include "forward/manual_endpoint.hpp"
#include "host/numbered_name.hpp"

namespace adit::forward {
namespace {

namespace fs = std::filesystem;

class DamagedMap : public MapsToManualEndpoint {
 protected:
  /// Stores a square grid in this column, as an earlier process did.
  void keep(std::uint64_t number, const char* robot, int column) {
    icd::MapUpdate map = grid_of(robot, 64);
    auto& grid = std::get<icd::OccupancyGrid>(map.msg);
    grid.origin.position.x = column * grid.width * grid.resolution;
    map.data.bytes = codec::gzip(map.data.bytes, codec::GzipStrategy::Runs);
    map.data.compression = icd::Compression::Gzip;
    ASSERT_TRUE(spool_.keep(number, std::move(map), 0));
  }
  std::string file(std::uint64_t number) const {
    return folder_ / host::numbered_name("map-", number, ".cbor");
  }
  void damage(std::uint64_t number) {
    std::fstream bytes(file(number), std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(40);  // in its cells
    bytes << "damaged";
  }
  void restore() { maps_->restore(spool_.read()); }
  api::ActivityRow row() const {
    const auto found = counts_.rows().find({Kind::Grid, "first"});
    return found == counts_.rows().end() ? api::ActivityRow{} : found->second;
  }
  static constexpr std::uint64_t kOne = MapStore::kFirstNumber + 1, kOther = MapStore::kFirstNumber + 2;
};

TEST_F(DamagedMap, IsDroppedAndTheNextOneIsSent) {
  keep(kOne, "first", 0);
  keep(kOther, "second", 0);
  damage(kOne);
  restore();
  EXPECT_EQ(maps_->waiting({Kind::Grid, "first"}), 1U) << "not read yet";
  post_.answer("200 OK");
  EXPECT_TRUE(receives({"second"}));
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return !fs::exists(file(kOne)); }));
  EXPECT_TRUE(fs::exists(file(kOne) + ".damaged"));
  EXPECT_EQ(maps_->waiting({Kind::Grid, "first"}), 0U);
  EXPECT_EQ(row().failed, 1U);
  EXPECT_TRUE(row().last_sentence.starts_with("its stored copy is damaged: ")) << row().last_sentence;
}

TEST_F(DamagedMap, IsDroppedAfterAManualRetry) {
  keep(kOne, "first", 0);
  damage(kOne);
  auto kept = spool_.read();
  maps_->send_again(std::move(kept[0].map), [](bool) { return true; });
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return row().failed == 1; }));
  EXPECT_TRUE(row().last_sentence.starts_with("its stored copy is damaged: ")) << row().last_sentence;
  EXPECT_EQ(maps_->waiting({Kind::Grid, "first"}), 0U);
}

TEST_F(DamagedMap, IsNotSentIfThisProcessAcceptedIt) {
  icd::MapUpdate map = grid_of("first", 64);
  map.data.compression = icd::Compression::Gzip;
  take(map);
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return row().failed == 1; }));
  EXPECT_TRUE(row().last_sentence.starts_with("its stored copy is damaged: ")) << row().last_sentence;
  EXPECT_EQ(maps_->waiting({Kind::Grid, "first"}), 0U);
}

TEST_F(DamagedMap, LeavesItsStitchedNeighbour) {
  keep(kOne, "first", 0);
  keep(kOther, "first", 1);
  damage(kOne);
  maps_->endpoint_changed(std::nullopt);  // without a token, maps stay queued
  restore();
  maps_->endpoint_changed(icd::BearerToken::parse("a-token"));
  post_.answer("200 OK");
  EXPECT_TRUE(receives({"first"}));
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return row().forwarded == 1; }));
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return fs::exists(file(kOne) + ".damaged"); }));
  EXPECT_EQ(row().failed, 1U);
  EXPECT_EQ(maps_->waiting({Kind::Grid, "first"}), 0U);
}

}  // namespace
}  // namespace adit::forward
