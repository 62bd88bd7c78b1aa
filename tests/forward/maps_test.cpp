#include "forward/maps.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <future>
#include <limits>
#include <vector>

#include "codec/bytes_of.hpp"
#include "codec/gzip.hpp"
#include "forward/fixtures.hpp"
#include "forward/sample_maps.hpp"
#include "host/files.hpp"
#include "host/folder.hpp"
#include "journal/left_in.hpp"
#include "loop/turn_until.hpp"
#include "spool/messages.hpp"

namespace adit::forward {
namespace {

namespace fs = std::filesystem;
using spool::cloud;

icd::MapUpdate grid(const char* robot, std::uint32_t width, std::size_t bytes) {
  icd::OccupancyGrid grid;
  grid.header.stamp = 1;
  grid.width = grid.height = width;
  grid.resolution = 0.25;
  return {icd::RobotName::parse(robot),
          grid,
          {icd::ChunkedBytes{std::vector<std::uint8_t>(bytes, 1)}, icd::Compression::Gzip,
           std::size_t{width} * width}};
}

/// Without a token, accepted maps stay queued.
class MapsTest : public testing::Test, protected MapsParts {
 protected:
  MapsTest() { settings_.queues.map_bytes = 100'000; }

  /// Returns the answer. `files_`: stored maps at that time. `behind`: a job of the writer after the map's.
  icd::Checked<void> accept(
      icd::MapUpdate update, std::function<void()> behind = [] {},
      const queues::Upload& upload = {.bytes = 10}) {
    std::optional<icd::Checked<void>> said;
    maps_.accept(std::move(update), upload, nullptr, [&](icd::Checked<void> taken) {
      files_ = files();
      said = std::move(taken);
    });
    writer_.submit(std::move(behind), [] {});
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return said.has_value(); }));
    return said.value_or(std::unexpected(icd::Refusal{icd::Status::Ok, "nothing was said"}));
  }
  std::size_t files() const {
    std::size_t count = 0;
    std::error_code none;  // the directory may be missing
    for (const auto& entry : fs::directory_iterator(folder_.path(), none)) {
      count += entry.path().extension() == ".cbor" ? 1 : 0;
    }
    return count;
  }
  bool has_files(std::size_t count) {
    return loop::turn_until(loop_, [&] { return files() == count; });
  }
  static icd::Status status(const icd::Checked<void>& said) {
    return said ? icd::Status::Ok : said.error().status;
  }

  Maps maps_ = maps_with(std::nullopt);
  std::size_t files_ = 0;
};

TEST_F(MapsTest, AreAnsweredOnceTheirFileExists) {
  EXPECT_EQ(status(accept(grid("r1", 10, 500))), icd::Status::Ok);
  EXPECT_EQ(files_, 1u);
}

TEST_F(MapsTest, AreNotAnsweredWhileTheWriterIsBusy) {
  std::promise<void> let_go;
  writer_.submit([until = let_go.get_future().share()] { until.wait(); }, [] {});
  bool said = false;
  maps_.accept(grid("r1", 10, 500), {.bytes = 10}, nullptr,
               [&](const icd::Checked<void>& taken) { said = taken.has_value(); });
  for (int i = 0; i < 10; ++i) loop_.turn(std::chrono::milliseconds{5});
  EXPECT_FALSE(said);
  EXPECT_FALSE(maps_.has_stored_all());
  EXPECT_EQ(maps_.queued_bytes(), 0u) << "stored before queued";
  let_go.set_value();
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return said; }));
  EXPECT_TRUE(maps_.has_stored_all());
}

TEST_F(MapsTest, AreDeletedOnceTheNewerOneIsStored) {
  std::promise<void> let_go;
  EXPECT_EQ(status(accept(grid("r1", 10, 500))), icd::Status::Ok);
  const auto waits = [until = let_go.get_future().share()] { until.wait(); };
  EXPECT_EQ(status(accept(grid("r1", 20, 700), waits)), icd::Status::Ok);
  EXPECT_EQ(files_, 2u) << "the older file is deleted later";
  let_go.set_value();
  EXPECT_TRUE(has_files(1));
}

/// A window that is off by `x` metres; half a cell is 0.125 m.
icd::MapUpdate window(double x) {
  icd::MapUpdate map = grid("r1", 20, 700);
  std::get<icd::OccupancyGrid>(map.msg).origin.position.x = x;
  return map;
}

TEST_F(MapsTest, KeepWhatTheyReplacedOverARestart) {
  EXPECT_EQ(status(accept(window(0))), icd::Status::Ok);
  EXPECT_EQ(status(accept(window(0.1))), icd::Status::Ok);
  ASSERT_TRUE(has_files(1));
  Maps next = maps_with(std::nullopt);
  next.restore(spool::Spool(folder_.path()).read());
  for (const auto& [x, queued] : {std::pair(0.2, 2u), std::pair(0.09, 1u)}) {
    bool taken = false;
    next.accept(window(x), {.bytes = 10}, nullptr,
                [&](const icd::Checked<void>& said) { taken = said.has_value(); });
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return taken; }));
    EXPECT_EQ(next.waiting({TrafficKind::Grid, "r1"}), queued) << x;
  }
}

/// The file of a grid does not show how long the grids that it replaced were queued.
TEST_F(MapsTest, KeepTheAgeOfWhatTheyReplacedOverARestart) {
  icd::MapUpdate newest = window(0);
  newest.header().stamp = loop_.stamp_now();
  EXPECT_EQ(status(accept(std::move(newest))), icd::Status::Ok);
  journal::Heard heard{.robot = "r1"};
  heard.behind[static_cast<std::size_t>(TrafficKind::Grid)] = loop_.stamp_now() - 30;
  journal::HandoverState carried;
  EXPECT_TRUE(carried.apply(journal::RecordKind::Heard, store::bytes_of(heard)));
  Maps next = maps_with(std::nullopt);
  next.restore(carried, /*ran_before=*/true);
  next.restore(spool::Spool(folder_.path()).read());
  const auto since = next.oldest_acceptance({TrafficKind::Grid, "r1"});
  ASSERT_TRUE(since);
  EXPECT_NEAR(std::chrono::duration<double>(loop_.now() - *since).count(), 30, 5);
}

/// 20 x 20 cells of 0.25 m at `x` metres, each with the number of its column.
icd::MapUpdate columns(double x, double stamp) {
  icd::MapUpdate map = window(x);
  map.header().stamp = stamp;
  std::vector<std::uint8_t> cells;
  for (std::uint8_t i = 0; i < 200; ++i)
    cells.insert(cells.end(),
                 {static_cast<std::uint8_t>(2 * i % 20), static_cast<std::uint8_t>((2 * i + 1) % 20)});
  map.data = {codec::gzip(icd::ChunkedBytes{cells}, codec::GzipStrategy::Runs), icd::Compression::Gzip,
              cells.size()};
  return map;
}

class OvertakenGrid : public MapsTest {
 protected:
  /// The upload of the older one begins first and ends last.
  icd::Status take_newer(icd::MapUpdate map) {
    return status(accept(std::move(map), [] {}, {.bytes = 10, .began = 2, .ended = 3, .overlaps = 1}));
  }
  icd::Status take_older(icd::MapUpdate map) {
    return status(accept(std::move(map), [] {}, {.bytes = 10, .began = 1, .ended = 4}));
  }
  spool::Spool::KeptMaps stored() {
    EXPECT_TRUE(loop::turn_until_idle(loop_, writer_));
    return spool::Spool(folder_.path()).read();
  }
  const facts::ActivityRow& row() const { return counts_.rows().at({TrafficKind::Grid, "r1"}); }
};

TEST_F(OvertakenGrid, IsQueuedOutsideOfTheNewerOne) {
  EXPECT_EQ(take_newer(columns(0, 10)), icd::Status::Ok);
  EXPECT_EQ(take_older(columns(-1, 9)), icd::Status::Ok);
  const auto kept = stored();
  ASSERT_EQ(kept.size(), 2u);
  const icd::MapUpdate& strip = kept[1].map;
  const auto& grid = std::get<icd::OccupancyGrid>(strip.msg);
  EXPECT_NEAR(grid.origin.position.x, -1, 0.001);
  EXPECT_EQ(grid.width, 4u);
  EXPECT_EQ(grid.height, 20u);
  const auto cells = codec::bytes_of(strip.data);
  ASSERT_EQ(cells.size(), 80u);
  for (std::size_t i = 0; i < cells.size(); ++i) EXPECT_EQ(cells[i], i % 4);
  EXPECT_EQ(row().accepted, 2u);
}

TEST_F(OvertakenGrid, IsNotQueuedIfTheNewerOneCoversIt) {
  EXPECT_EQ(take_newer(columns(0, 10)), icd::Status::Ok);
  EXPECT_EQ(take_older(columns(0.1, 9)), icd::Status::Ok);
  const auto kept = stored();
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].map.header().stamp, 10);
  EXPECT_EQ(row().accepted, 2u);
  EXPECT_EQ(row().replaced, 1u);
}

TEST_F(OvertakenGrid, IsTheNewestIfItHasTheNewerStamp) {
  EXPECT_EQ(take_newer(columns(0, 9)), icd::Status::Ok);
  EXPECT_EQ(take_older(columns(0.1, 10)), icd::Status::Ok);
  const auto kept = stored();
  ASSERT_EQ(kept.size(), 1u) << "it replaced the other one";
  EXPECT_EQ(kept[0].map.header().stamp, 10);
}

/// A third one, posted after the newest one, has an older stamp, because its client's clock was set back.
TEST_F(OvertakenGrid, IsNewerThanAThirdOneOnlyWithTheCellsThatAreQueued) {
  EXPECT_EQ(take_newer(columns(0, 10)), icd::Status::Ok);
  EXPECT_EQ(status(accept(columns(-1, 9), [] {}, {.bytes = 10, .began = 1, .ended = 5, .overlaps = 4})),
            icd::Status::Ok);
  EXPECT_EQ(status(accept(columns(0, 8), [] {}, {.bytes = 10, .began = 4, .ended = 6})), icd::Status::Ok);
  const auto kept = stored();
  ASSERT_EQ(kept.size(), 2u) << "the third one replaced the first one";
  EXPECT_EQ(std::get<icd::OccupancyGrid>(kept[0].map.msg).width, 4u);
  EXPECT_EQ(std::get<icd::OccupancyGrid>(kept[1].map.msg).width, 20u);
}

TEST_F(OvertakenGrid, IsQueuedAsAWholeOrNotAtAll) {
  EXPECT_EQ(take_newer(columns(0, 10)), icd::Status::Ok);
  icd::MapUpdate older = columns(-1, 9);
  std::get<icd::OccupancyGrid>(older.msg).origin.position.y = -1;  // two parts are left
  fs::create_directory(folder_ / host::numbered_name("map-", MapStore::kFirstNumber + 3, ".cbor"));
  EXPECT_EQ(take_older(older), icd::Status::ServiceUnavailable);
  EXPECT_EQ(maps_.waiting({TrafficKind::Grid, "r1"}), 1u);
  EXPECT_TRUE(loop::turn_until_idle(loop_, writer_));
  EXPECT_FALSE(fs::exists(folder_ / host::numbered_name("map-", MapStore::kFirstNumber + 2, ".cbor")));
  EXPECT_EQ(take_older(columns(-1, 9)), icd::Status::Ok) << "it is tried again";
}

TEST_F(OvertakenGrid, IsRejectedIfItsDataIsDamaged) {
  EXPECT_EQ(take_newer(columns(0, 10)), icd::Status::Ok);
  icd::MapUpdate damaged = columns(-1, 9);
  auto bytes = damaged.data.bytes.to_vector();
  bytes[bytes.size() / 2] ^= 0x55;
  damaged.data.bytes = icd::ChunkedBytes{bytes};
  EXPECT_NE(take_older(damaged), icd::Status::Ok);
  EXPECT_EQ(stored().size(), 1u);
}

TEST_F(MapsTest, AreNotDeletedIfTheBoundsOfTheNewerOneCannotBeStored) {
  EXPECT_EQ(status(accept(window(0))), icd::Status::Ok);
  const auto bounds_file = host::numbered_name("map-", MapStore::kFirstNumber + 2, ".bounds");
  fs::create_directory(folder_ / bounds_file);
  std::ofstream(folder_ / (bounds_file + "/in_the_way")) << "x";
  EXPECT_EQ(status(accept(window(0.1))), icd::Status::Ok);
  EXPECT_TRUE(loop::turn_until_idle(loop_, writer_));
  EXPECT_EQ(files(), 2u) << "a process that starts now finds both";
  EXPECT_EQ(maps_.waiting({TrafficKind::Grid, "r1"}), 1u);
}

TEST_F(MapsTest, KeepWhatARetriedGridReplaced) {
  const auto bounds = [](double x) {
    return icd::GridBounds::from_grid(std::get<icd::OccupancyGrid>(window(x).msg));
  };
  bool kept = false;
  maps_.resend(
      window(0.1), [&](bool well) { return kept = well; }, icd::joint_bounds(bounds(0.1), bounds(0)));
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return kept; }));
  EXPECT_EQ(status(accept(window(0.2))), icd::Status::Ok);
  EXPECT_EQ(maps_.waiting({TrafficKind::Grid, "r1"}), 2u);
  const auto stored = spool::Spool(folder_.path()).read();
  ASSERT_EQ(stored.size(), 2u);
  EXPECT_EQ(stored.front().bounds, icd::joint_bounds(bounds(0.1), bounds(0)));
}

TEST_F(MapsTest, StandForARetriedGridOverARestart) {
  EXPECT_EQ(status(accept(window(0))), icd::Status::Ok);
  std::optional<bool> kept;
  maps_.resend(window(0.1), [&](bool well) {
    kept = well;
    return true;
  });
  EXPECT_EQ(kept, true) << "the newer grid contains it";
  ASSERT_TRUE(loop::turn_until_idle(loop_, writer_));
  const auto stored = spool::Spool(folder_.path()).read();
  ASSERT_EQ(stored.size(), 1u);
  ASSERT_TRUE(stored.front().bounds);
  EXPECT_NEAR(stored.front().bounds->high.x, 5.1, 1e-9);
}

/// A process may be killed at any byte.
TEST_F(MapsTest, AssumeSentGridsAfterAnyTruncation) {
  journal_.begin({.boot = "boot", .at = {}, .stamp = 1});
  maps_.restore({}, /*ran_before=*/true);
  for (const auto& entry : fs::directory_iterator(journal_folder_.path())) {
    for (std::uintmax_t size = 0; size <= entry.file_size(); ++size) {
      const host::Folder cut;
      const fs::path file = fs::path(cut.path()) / entry.path().filename();
      fs::copy_file(entry.path(), file);
      fs::resize_file(file, size);
      const auto left = journal::Journal(loop_, cut.path()).read();
      EXPECT_TRUE(!left.grids() || left.grids()->contains(queues::Canvases::kAnyName)) << size;
    }
  }
  EXPECT_TRUE(journal::left_in(journal_folder_.path()).grids());
}

/// After a restart, the highest number is the newest map.
TEST_F(MapsTest, ReplaceARetriedGridByANewerCoveringOne) {
  EXPECT_EQ(status(accept(grid("r1", 20, 700))), icd::Status::Ok);
  std::optional<bool> kept;
  maps_.resend(grid("r1", 10, 500), [&](bool is_kept) {
    kept = is_kept;
    return true;
  });
  EXPECT_EQ(kept, true) << "the newer grid covers it";
  EXPECT_TRUE(has_files(1));
  EXPECT_TRUE(maps_.has_stored_all());
}

TEST_F(MapsTest, KeepARetriedGridOldestAfterARestart) {
  EXPECT_EQ(status(accept(grid("r1", 10, 500))), icd::Status::Ok);
  bool kept = false;
  maps_.resend(grid("r1", 20, 700), [&](bool well) { return kept = well; });
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return kept; }));
  EXPECT_EQ(maps_.waiting({TrafficKind::Grid, "r1"}), 2u);
  Maps next = maps_with(std::nullopt);
  for (const std::uint64_t number : host::numbers_in(folder_.path(), "map-", ".cbor").value())
    next.restore({{number, number == 1 ? grid("r1", 20, 700) : grid("r1", 10, 500)}});
  EXPECT_EQ(next.waiting({TrafficKind::Grid, "r1"}), 2u) << "it covers the other grid but is older";
}

/// A map in packing or in flight is not in the queue.
TEST_F(MapsTest, ReplaceARetriedGridByOneInPacking) {
  Maps maps = maps_with(icd::BearerToken::parse("a-token"));
  std::promise<void> let_go;
  workers_.submit(loop::Urgency::OnTheWay, [until = let_go.get_future().share()] { until.wait(); }, [] {});
  bool taken = false;
  maps.accept(grid("r1", 20, 700), {.bytes = 10}, nullptr,
              [&](const icd::Checked<void>& said) { taken = said.has_value(); });
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return taken && maps.packing(); }));
  std::optional<bool> kept;
  maps.resend(grid("r1", 10, 500), [&](bool well) {
    kept = well;
    return true;
  });
  EXPECT_EQ(kept, true) << "the newer grid covers it";
  EXPECT_EQ(maps.waiting({TrafficKind::Grid, "r1"}), 1u);
  EXPECT_EQ(files(), 1u);
  let_go.set_value();
}

TEST_F(MapsTest, DropARetriedGridIfItWasReplacedMeanwhile) {
  std::optional<bool> kept;
  maps_.resend(grid("r1", 10, 500), [&](bool well) {
    kept = well;
    return false;
  });
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return kept.has_value(); }));
  EXPECT_EQ(maps_.queued_bytes(), 0u);
  EXPECT_TRUE(has_files(0));
}

TEST_F(MapsTest, ReplaceQueuedMapsInAFullQueue) {
  EXPECT_EQ(status(accept(grid("r1", 10, 50'000))), icd::Status::Ok);
  EXPECT_EQ(status(accept(grid("r2", 10, 40'000))), icd::Status::Ok);
  EXPECT_EQ(status(accept(grid("r3", 10, 20'000))), icd::Status::TooManyRequests);
  EXPECT_EQ(counts_.rows().at({TrafficKind::Grid, "r3"}).no_room, 1u);
  EXPECT_EQ(status(accept(grid("r1", 20, 60'000))), icd::Status::Ok);
  EXPECT_TRUE(has_files(2));
}

TEST_F(MapsTest, AreCountedIfTheyHaveNoValidPoint) {
  settings_.robots = {{.name = "r1", .alias = "", .clouds = queues::Clouds::Whole}};
  maps_.on_settings_changed();
  const Traffic traffic{TrafficKind::Cloud, "r1"};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(accept(cloud_along_x("r1", {1, 2})));
  EXPECT_TRUE(accept(cloud_along_x("r1", {nan, nan, nan})));
  EXPECT_EQ(maps_.waiting(traffic), 1u);
  EXPECT_TRUE(has_files(1));
  EXPECT_EQ(counts_.rows().at(traffic).accepted, 2u);
  EXPECT_EQ(counts_.rows().at(traffic).replaced, 0u);
  EXPECT_EQ(counts_.rows().at(traffic).no_valid_point, 1u);
  ASSERT_TRUE(accept(cloud_along_x("r2", {})));
  EXPECT_EQ(maps_.waiting({TrafficKind::Cloud, "r2"}), 1u) << "posted without points";
}

TEST_F(MapsTest, WaitSinceTheOldestOfTheirRobotAndKind) {
  const Traffic traffic{TrafficKind::Grid, "r1"};
  EXPECT_FALSE(maps_.oldest_acceptance(traffic)) << "nothing is queued";
  ASSERT_TRUE(accept(grid("r1", 10, 500)));
  const auto since = maps_.oldest_acceptance(traffic);
  ASSERT_TRUE(since);
  ASSERT_TRUE(accept(grid("r2", 10, 500)));
  ASSERT_TRUE(accept(grid("r1", 20, 500)));
  EXPECT_EQ(maps_.oldest_acceptance(traffic), since) << "the oldest counts";
  EXPECT_GT(*maps_.oldest_acceptance({TrafficKind::Grid, "r2"}), *since);
  EXPECT_FALSE(maps_.oldest_acceptance({TrafficKind::Cloud, "r1"}));
}

TEST_F(MapsTest, AreLimitedInNumberUnlessTheyMerge) {
  settings_.robots = {{.name = "r1", .alias = "", .clouds = queues::Clouds::Parts}};
  maps_.on_settings_changed();
  settings_.queues.map_bytes = std::size_t{1} << 30;
  const auto cloud_of = [](bool is_bigendian) {
    icd::MapUpdate map = cloud(1);
    std::get<icd::PointCloud2>(map.msg).is_bigendian = is_bigendian;
    return map;
  };
  std::size_t taken = 0;
  for (std::size_t i = 0; i < Maps::kMostMaps; ++i) {
    maps_.accept(cloud_of(i % 2 == 0), {.bytes = 10}, nullptr, [&](const icd::Checked<void>& said) {
      if (said) ++taken;
    });
    loop_.turn(std::chrono::milliseconds{0});
  }
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return maps_.has_stored_all(); }, std::chrono::seconds{60}));
  EXPECT_EQ(taken, Maps::kMostMaps);
  EXPECT_EQ(status(accept(cloud_of(true))), icd::Status::TooManyRequests);
  EXPECT_EQ(status(accept(cloud_of(false))), icd::Status::Ok) << "merged into the last queued one";
  EXPECT_EQ(status(accept(cloud_of(true))), icd::Status::TooManyRequests);
}

TEST_F(MapsTest, AreRejectedWithAReasonIfAWriteFails) {
  fs::remove_all(folder_.path());
  const std::string path = folder_.path();
  {
    std::ofstream(path) << "in the way";
  }
  const auto said = accept(grid("r1", 10, 500));
  ASSERT_FALSE(said);
  EXPECT_EQ(said.error().status, icd::Status::ServiceUnavailable);
  EXPECT_EQ(maps_.trouble(), said.error().sentence);
  fs::remove(path);
  EXPECT_EQ(status(accept(grid("r1", 10, 500))), icd::Status::Ok) << "in a new directory";
  EXPECT_EQ(maps_.trouble(), "");
}

TEST_F(MapsTest, AreStoredBeforeARetryIsConfirmed) {
  std::promise<void> let_go;
  writer_.submit([until = let_go.get_future().share()] { until.wait(); }, [] {});
  std::optional<bool> kept;
  std::size_t files_then = 0;
  maps_.resend(grid("r1", 10, 500), [&](bool well) {
    kept = well;
    files_then = files();
    return true;
  });
  for (int i = 0; i < 10; ++i) loop_.turn(std::chrono::milliseconds{5});
  EXPECT_FALSE(kept);
  EXPECT_FALSE(maps_.has_stored_all());
  let_go.set_value();
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return kept.has_value(); }));
  EXPECT_EQ(kept, true);
  EXPECT_EQ(files_then, 1u);
  EXPECT_GT(maps_.queued_bytes(), 0u);
}

TEST_F(MapsTest, StayRejectedIfARetryCannotBeStored) {
  fs::remove_all(folder_.path());
  {
    std::ofstream(folder_.path()) << "in the way";
  }
  std::optional<bool> kept;
  maps_.resend(grid("r1", 10, 500), [&](bool well) {
    kept = well;
    return true;
  });
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return kept.has_value(); }));
  EXPECT_EQ(kept, false);
  EXPECT_EQ(maps_.queued_bytes(), 0u);
  fs::remove(folder_.path());
}

}  // namespace
}  // namespace adit::forward
