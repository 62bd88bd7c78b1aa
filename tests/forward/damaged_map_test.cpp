// Stored maps with damaged data. Packing detects the damage.
#include <filesystem>
#include <fstream>

#include "codec/gzip.hpp"
#include "forward/manual_endpoint.hpp"
#include "host/files.hpp"
#include "host/service.hpp"
#include "loop/simulated_time.hpp"
#include "loop/watchdog.hpp"

namespace adit::forward {
namespace {

namespace fs = std::filesystem;

class DamagedMap : public MapsToManualEndpoint {
 protected:
  /// A square grid in this column.
  static icd::MapUpdate grid_in(const char* robot, int column) {
    icd::MapUpdate map = grid_of(robot, 64);
    auto& grid = std::get<icd::OccupancyGrid>(map.msg);
    grid.origin.position.x = column * grid.width * grid.resolution;
    map.data.bytes = codec::gzip(map.data.bytes, codec::GzipStrategy::Runs);
    map.data.compression = icd::Compression::Gzip;
    return map;
  }
  /// Stores it, as an earlier process did.
  void keep(std::uint64_t number, const char* robot, int column) {
    ASSERT_TRUE(spool_.keep(number, grid_in(robot, column), 0));
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
  facts::ActivityRow row() const {
    const auto found = counts_.rows().find({TrafficKind::Grid, "first"});
    return found == counts_.rows().end() ? facts::ActivityRow{} : found->second;
  }
  static constexpr std::uint64_t kOne = MapStore::kFirstNumber + 1, kOther = MapStore::kFirstNumber + 2;
};

TEST_F(DamagedMap, IsDroppedAndTheNextOneIsSent) {
  keep(kOne, "first", 0);
  keep(kOther, "second", 0);
  damage(kOne);
  restore();
  EXPECT_EQ(maps_->waiting({TrafficKind::Grid, "first"}), 1U) << "not read yet";
  post_.answer("200 OK");
  EXPECT_TRUE(receives({"second"}));
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return !fs::exists(file(kOne)); }));
  EXPECT_TRUE(fs::exists(file(kOne) + ".damaged"));
  EXPECT_EQ(maps_->waiting({TrafficKind::Grid, "first"}), 0U);
  EXPECT_EQ(row().failed, 1U);
  EXPECT_TRUE(row().last_sentence.starts_with("its stored copy is damaged: ")) << row().last_sentence;
}

TEST_F(DamagedMap, IsDroppedAfterAManualRetry) {
  keep(kOne, "first", 0);
  damage(kOne);
  auto kept = spool_.read();
  maps_->resend(std::move(kept[0].map), [](bool) { return true; });
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return row().failed == 1; }));
  EXPECT_TRUE(row().last_sentence.starts_with("its stored copy is damaged: ")) << row().last_sentence;
  EXPECT_EQ(maps_->waiting({TrafficKind::Grid, "first"}), 0U);
}

TEST_F(DamagedMap, IsNotSentIfThisProcessAcceptedIt) {
  icd::MapUpdate map = grid_of("first", 64);
  map.data.compression = icd::Compression::Gzip;
  accept(map);
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return row().failed == 1; }));
  EXPECT_TRUE(row().last_sentence.starts_with("its stored copy is damaged: ")) << row().last_sentence;
  EXPECT_EQ(maps_->waiting({TrafficKind::Grid, "first"}), 0U);
}

TEST_F(DamagedMap, LeavesItsStitchedNeighbour) {
  keep(kOne, "first", 0);
  keep(kOther, "first", 1);
  damage(kOne);
  maps_->on_endpoint_changed(std::nullopt);  // without a token, maps stay queued
  restore();
  maps_->on_endpoint_changed(icd::BearerToken::parse("a-token"));
  post_.answer("200 OK");
  EXPECT_TRUE(receives({"first"}));
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return row().forwarded == 1; }));
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return fs::exists(file(kOne) + ".damaged"); }));
  EXPECT_EQ(row().failed, 1U);
  EXPECT_EQ(maps_->waiting({TrafficKind::Grid, "first"}), 0U);
}

/// A process packed map kOne at its end, `times` times.
class FaultyMap : public DamagedMap {
 protected:
  void end_by_faults(int times) {
    for (int i = 0; i < times; ++i) {
      const fs::path folder = folder_.path(), killed = folder.string() + ".killed";
      {
        spool::Spool before(folder);
        (void)before.read();
        before.begin_work({kOne});
        before.record_overrun();
        fs::copy_file(folder / "at-work", killed);
      }
      fs::rename(killed, folder / "at-work");
    }
  }
};

TEST_F(FaultyMap, IsPutAsideWithItsSenderAndReasonUntilTheOperatorDecides) {
  keep(kOne, "first", 0);
  keep(kOther, "second", 0);
  end_by_faults(3);
  restore();
  post_.answer("200 OK");
  EXPECT_TRUE(receives({"second"}));
  ASSERT_EQ(rejected_.rows().size(), 1u);
  EXPECT_EQ(rejected_.rows()[0].status, 0);
  EXPECT_EQ(rejected_.put_aside(),
            "message 1, first's grid: the service ended 3 times by a fault while it packed this map");
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return !fs::exists(file(kOne)); }));
  EXPECT_EQ(row().failed, 1U);
  RejectedStore next(loop_, writer_, rejected_folder_.path());
  next.restore();
  EXPECT_EQ(next.put_aside(), rejected_.put_aside()) << "in a later process";
  EXPECT_EQ(next.begin_resend(1)->faults, 3);
}

TEST_F(FaultyMap, IsPutAsideAtItsNextFaultIfTheOperatorSendsItAgain) {
  maps_->on_endpoint_changed(std::nullopt);  // without a token, maps stay queued
  maps_->resend(grid_in("first", 0), [](bool) { return true; }, {}, /*faults=*/3);
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return maps_->waiting({TrafficKind::Grid, "first"}) == 1; }));
  const auto kept = spool::Spool(folder_.path()).read();
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].ends.faults, 3);
}

TEST_F(FaultyMap, IsNoMapWhosePackingWasKilled) {
  keep(kOne, "first", 0);
  end_by_faults(2);
  restore();
  post_.answer("200 OK");
  EXPECT_TRUE(receives({"first"}));
  EXPECT_TRUE(rejected_.rows().empty());
}

struct WithTime {
  loop::SimulatedTime time_;
};
class SlowMap : WithTime, public MapsToManualEndpoint {
 protected:
  std::string work() const { return host::read_file(spool_.work_file()).value_or(""); }
  using WithTime::time_;
};

TEST_F(SlowMap, IsAtFaultIfItTakesLongerThanTheWatchdogAllows) {
  accept(cloud_along_x("first", std::vector<float>(3'000'000, 1)));
  EXPECT_TRUE(loop::turn_until(loop_, [&] {
    time_.pass(loop::Watchdog::kLongestJob);
    return work() == "1048577 0 0 1\nx";
  }));
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return work().empty(); })) << "it was only slow";
}

}  // namespace
}  // namespace adit::forward
