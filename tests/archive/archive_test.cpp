#include "archive/archive.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <optional>
#include <thread>

#include "archive/a_run.hpp"
#include "host/folder.hpp"
#include "loop/turn_until.hpp"
#include "project_files.hpp"

namespace adit::archive {
namespace {

namespace fs = std::filesystem;

class ArchiveTest : public testing::Test {
 protected:
  /// Starts a process that has only the data on the disk.
  void live(const Head& head) {
    archive.reset();
    archive.emplace(loop, folder.path());
    picture = picture::Mosaic();
    tracks.clear();
    bool came = false;
    archive->begin(head, [&](picture::Mosaic kept, std::vector<api::Track> its) -> const picture::Mosaic& {
      picture = std::move(kept);
      tracks = std::move(its);
      came = true;
      return run.easel.mosaic;
    });
    ASSERT_TRUE(loop::turn_until(loop, [&] { return came; }));
  }
  void write() {
    archive->tick(run.seen());
    archive->write_now(run.seen());
    ASSERT_TRUE(loop::turn_until_idle(loop, archive->thread()));
  }
  std::uint64_t stored() const {
    std::uint64_t bytes = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "runs"))
      bytes += entry.is_regular_file() ? entry.file_size() : 0;
    return bytes;
  }

  host::Folder folder;
  loop::Loop loop;
  ARun run;
  std::optional<Archive> archive;
  picture::Mosaic picture;
  std::vector<api::Track> tracks;
};

TEST_F(ArchiveTest, RestoresPictureTracksAndPlotsAfterARestart) {
  live(run.head);
  EXPECT_TRUE(picture.layers().empty());
  run.draw(3);
  archive->set_attention({"no token"}, run.now());
  write();
  live(run.head);
  EXPECT_EQ(shown(picture), shown(run.easel.mosaic));
  ASSERT_EQ(tracks.size(), 1U);
  EXPECT_EQ(tracks[0].poses[0].position.y, 2);
  const api::History plots = archive->history(0);
  EXPECT_THAT(plots.sent_mbit, testing::ElementsAre(1.5));
  ASSERT_EQ(plots.attention.size(), 1U);
  EXPECT_EQ(plots.attention[0].sentence, "no token");
}

/// Commit 937b95d6 wrote the files of the run.
TEST_F(ArchiveTest, ReadsARunOfAnEarlierVersion) {
  fs::create_directory(folder / "runs");
  fs::copy(project_file("tests/archive/earlier"), folder / "runs/3");
  live(run.head);
  run.easel.draw(picture::grid_at(0, 0, 2, 0.25, {0, 100, 100, 0}));
  ASSERT_EQ(picture.layers().size(), 1U);
  const picture::LayerView layer = picture.layers()[0], drawn = run.easel.mosaic.layers()[0];
  EXPECT_EQ(layer.layer, drawn.layer);
  EXPECT_EQ(layer.bounds, drawn.bounds);
  ASSERT_EQ(layer.tiles.size(), drawn.tiles.size());
  for (const picture::TileView& tile : layer.tiles) {
    picture::Packer packer;
    picture::Pixels is, was;
    packer.unpack(*picture.tile(layer.layer, tile.at, {}).tile, is);
    packer.unpack(*run.easel.mosaic.tile(layer.layer, tile.at, {}).tile, was);
    EXPECT_EQ(is, was) << "level " << tile.at.level;
  }
  ASSERT_EQ(tracks.size(), 1U);
  EXPECT_EQ(tracks[0].robot, "ugv1");
  ASSERT_EQ(tracks[0].poses.size(), 1U);
  const api::TrackPose& pose = tracks[0].poses[0];
  EXPECT_EQ(std::tie(pose.at, pose.position, pose.heading), std::tuple(1001, icd::Point{1, 2, 3}, 0.5));

  const api::History plots = archive->history(0);
  EXPECT_THAT(plots.at, testing::ElementsAre(1011));
  EXPECT_THAT(plots.sent_mbit, testing::ElementsAre(1.5));
  EXPECT_THAT(plots.queued_bytes, testing::ElementsAre(7));
  EXPECT_THAT(plots.scoring_ms, testing::ElementsAre(12));
  EXPECT_THAT(plots.mapping_ms, testing::ElementsAre(std::nullopt));
  ASSERT_EQ(plots.robots.size(), 1U);
  EXPECT_EQ(plots.robots[0].robot, "ugv1");
  EXPECT_THAT(plots.robots[0].ages, testing::ElementsAre(4));
  ASSERT_EQ(plots.attention.size(), 1U);
  EXPECT_EQ(plots.attention[0].sentence, "no token");

  const auto facts = RunsFolder(folder.path()).facts_of("3").value();
  ASSERT_TRUE(facts);
  EXPECT_EQ(std::tie(facts->run, facts->course, facts->began, facts->last, facts->score),
            std::tuple(3, "alpha", 990, 1011, 5));
}

TEST_F(ArchiveTest, RestoresEarlierTimesAfterARestart) {
  live(run.head);
  run.draw(1);
  write();
  const double then = run.easel.now;
  const std::string before = shown(run.easel.mosaic, then);
  run.easel.now += 100;
  run.easel.draw(picture::grid_at(0, 0, 1, 0.25, {100}));
  run.easel.draw(picture::grid_at(0, 0, 1, 0.25, {0}));
  write();
  live(run.head);
  EXPECT_EQ(shown(picture, then), before);
  EXPECT_EQ(shown(picture), shown(run.easel.mosaic));
  EXPECT_NE(shown(picture), before);
}

TEST_F(ArchiveTest, KeepsThePictureOfAnEndedRun) {
  live(run.head);
  run.draw(100);  // more than is written at once
  write();
  run.easel.now += 1;  // soon after some tiles were written
  run.easel.draw(picture::grid_at(0, 0, 1, 0.25, {100}));
  run.easel.draw(picture::grid_at(0, 0, 1, 0.25, {0}));
  archive->tick(run.seen());
  archive->end_run(run.seen());
  live({.run = 4, .began = 2000, .post = run.head.post});
  std::string kept;
  archive->read("3", [&](auto its) { kept = shown(its.value()->picture); });
  ASSERT_TRUE(loop::turn_until(loop, [&] { return !kept.empty(); }));
  EXPECT_EQ(kept, shown(run.easel.mosaic));
}

TEST_F(ArchiveTest, WritesALineOnceIfItsTilesCannotBeWritten) {
  live(run.head);
  fs::create_directory(folder / "runs/3/map-00000001");  // in the place of the tiles' file
  run.draw(1);
  archive->set_attention({"no token"}, run.now());
  archive->tick(run.seen());
  ASSERT_TRUE(loop::turn_until_idle(loop, archive->thread()));
  EXPECT_NE(archive->trouble(), "");
  fs::remove(folder / "runs/3/map-00000001");
  write();
  EXPECT_EQ(archive->trouble(), "");
  live(run.head);
  EXPECT_EQ(archive->history(0).attention.size(), 1U);
  EXPECT_EQ(archive->history(0).at.size(), 1U);
  EXPECT_EQ(shown(picture), shown(run.easel.mosaic));
}

TEST_F(ArchiveTest, RestoresAllTimesAfterAClockStep) {
  run.easel.now = 1e9;
  run.tracks[0].poses[0].at = 1e9;
  for (const double step : {3e8, -6e8}) {
    live(run.head);
    run.draw(1);
    write();
    archive->move(step);
    run.easel.mosaic.move(step);
    run.easel.now += step;
    run.clock_ahead += step;
    for (api::TrackPose& pose : run.tracks[0].poses) pose.at += step;
    const double then = run.easel.now;
    run.easel.now += 100;
    run.easel.draw(picture::grid_at(0, 0, 1, 0.25, {100}));
    run.tracks[0].poses.push_back({.at = run.easel.now, .position = {4, 5, 6}});
    write();
    const std::string before = shown(run.easel.mosaic, then), last = shown(run.easel.mosaic);
    const auto poses = run.tracks[0].poses.size();
    live(run.head);
    EXPECT_EQ(shown(picture), last) << "the newest tile is missing";
    EXPECT_EQ(shown(picture, then), before);
    ASSERT_EQ(tracks.size(), 1U);
    EXPECT_EQ(tracks[0].poses.size(), poses);
    EXPECT_NEAR(archive->history(0).at.back(), run.now(), 1);
    EXPECT_GT(archive->history(0).at.front(), then - 1000);
  }
}

TEST_F(ArchiveTest, WritesNothingForAnIdleRunUntilOtherDataComes) {
  live(run.head);
  const auto tick = [&] {
    archive->tick(run.seen());
    ASSERT_TRUE(loop::turn_until_idle(loop, archive->thread()));
  };
  tick();
  const std::uint64_t before = stored();
  const auto facts = fs::last_write_time(folder / "runs/3/facts.json");
  std::this_thread::sleep_for(Archive::kWriteEvery);
  run.easel.now += 10;
  api::TrackPose pose = run.tracks[0].poses.back();
  pose.at = run.now();
  run.tracks[0].poses.push_back(pose);
  tick();
  EXPECT_EQ(stored(), before);
  archive->set_attention({"no token"}, run.now());
  std::this_thread::sleep_for(Archive::kWriteEvery);
  tick();
  EXPECT_GT(stored(), before);
  EXPECT_EQ(fs::last_write_time(folder / "runs/3/facts.json"), facts) << "the facts did not change";
  live(run.head);
  ASSERT_EQ(tracks.size(), 1U);
  EXPECT_EQ(tracks[0].poses.size(), 2U);
  EXPECT_EQ(archive->history(0).at.size(), 2U);
}

TEST_F(ArchiveTest, KeepsRunsApart) {
  live(run.head);
  run.draw(2);
  write();
  const Head other{.run = 4, .began = 2000, .post = run.head.post};
  live(other);
  EXPECT_TRUE(picture.layers().empty());
  EXPECT_TRUE(tracks.empty());
  live(run.head);
  EXPECT_EQ(picture.layers().size(), 1U);
  const Head same_number{.run = 3, .began = 5000, .post = run.head.post};
  live(same_number);
  EXPECT_TRUE(picture.layers().empty()) << "run 3 of another ledger";
}

TEST_F(ArchiveTest, ListsThePresentRunFromItsStart) {
  live(run.head);
  ASSERT_TRUE(loop::turn_until_idle(loop, archive->thread()));
  const api::RunList all = archive->list();
  ASSERT_EQ(all.runs.size(), 1U);
  EXPECT_EQ(all.runs[0].key, "3");
  EXPECT_TRUE(all.runs[0].is_present);
}

TEST_F(ArchiveTest, ShowsThePresentRunAsItIsNow) {
  live(run.head);
  write();
  run.facts.score = 7;
  archive->tick(run.seen());
  EXPECT_EQ(archive->list().runs.at(0).score, 7);
  EXPECT_TRUE(loop::turn_until(loop, [&] { return archive->list().runs.at(0).bytes > 0; }));
  std::optional<api::RunRow> read;
  archive->read("3", [&](auto its) { read = its.value()->facts; });
  std::string html;
  archive->report("3", {}, {}, [&](auto its) { html = its.value(); });
  ASSERT_TRUE(loop::turn_until(loop, [&] { return !html.empty(); }));
  EXPECT_EQ(read->score, 7);
  EXPECT_THAT(html, testing::HasSubstr("<dt>Score</dt><dd>7</dd>"));
}

TEST_F(ArchiveTest, TellsStartAndEndOfARunByOneClock) {
  constexpr double kMonth = 30 * 86400;
  live(run.head);
  run.clock_ahead = kMonth;
  run.easel.now += kMonth;
  write();
  const double lasted = run.stamp() - run.head.began;
  const auto expect_it = [&](const api::RunRow& row, double last) {
    EXPECT_EQ(row.last, last);
    EXPECT_EQ(row.last - row.began, lasted);
  };
  expect_it(archive->list().runs.at(0), run.now());
  std::optional<api::RunRow> read;
  archive->read("3", [&](auto its) { read = its.value()->facts; });
  ASSERT_TRUE(loop::turn_until(loop, [&] { return read.has_value(); }));
  expect_it(*read, run.now());
  archive->move(-kMonth);
  expect_it(archive->list().runs.at(0), run.now() - kMonth);
  live({.run = 4, .began = 2000, .post = run.head.post});
  ASSERT_TRUE(loop::turn_until(loop, [&] { return archive->list().runs.size() == 2; }));
  expect_it(archive->list().runs.at(1), run.now());  // unchanged
  live(run.head);
  EXPECT_EQ(archive->list().runs.at(0).key, "3") << "the run is still the same";
}

TEST_F(ArchiveTest, KeepsTheFactsOfAnEndedRun) {
  live(run.head);
  write();
  run.facts.score = 7;
  archive->tick(run.seen());
  run.facts.score = 0;  // of the run that is about to become the current one
  archive->end_run(run.seen());
  live({.run = 4, .began = 2000, .post = run.head.post});
  ASSERT_TRUE(loop::turn_until(loop, [&] { return archive->list().runs.size() == 2; }));
  EXPECT_EQ(archive->list().runs.at(1).score, 7);
}

TEST_F(ArchiveTest, ListsTheLatestRunFirstAndDeletesOldRuns) {
  live(run.head);
  write();
  live({.run = 4, .began = 2000, .post = run.head.post});
  run.facts.run = 4;
  run.easel.now += 1000;
  write();
  ASSERT_TRUE(loop::turn_until(loop, [&] { return archive->list().runs.size() == 2; }));
  const api::RunList all = archive->list();
  EXPECT_EQ(all.runs[0].key, "4");
  EXPECT_TRUE(all.runs[0].is_present);
  EXPECT_EQ(all.runs[1].course, "alpha");
  EXPECT_EQ(all.runs[1].score, 5);
  std::optional<std::expected<void, std::string>> outcome;
  const auto done = [&](std::expected<void, std::string> its) { outcome = std::move(its); };
  archive->remove("4", done);
  EXPECT_FALSE(*outcome) << "the current run cannot be deleted";
  archive->remove("../3", done);
  ASSERT_TRUE(loop::turn_until_idle(loop, archive->thread()));
  EXPECT_FALSE(*outcome);
  archive->remove("3", done);
  ASSERT_TRUE(loop::turn_until_idle(loop, archive->thread()));
  EXPECT_TRUE(*outcome);
  EXPECT_EQ(archive->list().runs.size(), 1U);
  EXPECT_FALSE(fs::exists(folder / "runs/3"));
}

TEST_F(ArchiveTest, KeepsItsListIfTheDirectoryCannotBeListed) {
  live(run.head);
  write();
  ASSERT_TRUE(loop::turn_until(loop, [&] { return archive->list().runs.at(0).bytes > 0; }));
  ASSERT_TRUE(loop::turn_until_idle(loop, archive->thread()));
  fs::remove_all(folder / "runs");
  std::ofstream(folder / "runs") << "no directory";
  archive->begin({.run = 4, .began = 2000, .post = run.head.post},
                 [&](auto&&...) -> const picture::Mosaic& { return picture; });
  ASSERT_TRUE(loop::turn_until(loop, [&] { return !archive->list().unreadable.empty(); }));
  const api::RunList all = archive->list();
  EXPECT_NE(std::ranges::find(all.runs, "3", &api::RunRow::key), all.runs.end());
  EXPECT_THAT(all.unreadable, testing::HasSubstr("runs"));
}

TEST_F(ArchiveTest, DoesNotTakeAnUnreadableRunForAnAbsentOne) {
  live(run.head);
  write();
  ASSERT_TRUE(loop::turn_until_idle(loop, archive->thread()));
  for (const auto& file : fs::directory_iterator(folder / "runs/3")) {
    fs::remove(file);
    fs::create_directory(file);
  }
  std::optional<std::string> read, reported;
  std::optional<icd::Status> absent;
  archive->read("3", [&](auto its) { read = its.error().sentence; });
  archive->report("3", {}, {}, [&](auto its) { reported = its.error().sentence; });
  archive->read("9", [&](auto its) { absent = its.error().status; });
  ASSERT_TRUE(loop::turn_until(loop, [&] { return absent.has_value(); }));
  EXPECT_THAT(*read, testing::HasSubstr("runs/3"));
  EXPECT_EQ(reported, read);
  EXPECT_EQ(absent, icd::Status::NotFound);
}

TEST_F(ArchiveTest, ReadsAnEndedRun) {
  live(run.head);
  run.draw(2);
  write();
  std::optional<std::shared_ptr<const api::KeptRun>> read;
  archive->read("3", [&](auto its) { read = its.value(); });
  ASSERT_TRUE(loop::turn_until(loop, [&] { return read.has_value(); }));
  ASSERT_NE(*read, nullptr);
  EXPECT_EQ(shown((*read)->picture), shown(run.easel.mosaic));
  EXPECT_EQ((*read)->facts.course, "alpha");
  EXPECT_EQ((*read)->history.at.size(), 1U);
  EXPECT_TRUE((*read)->history.attention.empty());
  std::fstream(folder / "runs/3/lines-00000001", std::ios::in | std::ios::out)
      .seekp(-1, std::ios::end)
      .put('x');
  read.reset();
  archive->read("3", [&](auto its) { read = its.value(); });
  ASSERT_TRUE(loop::turn_until(loop, [&] { return read.has_value(); }));
  ASSERT_EQ((*read)->history.attention.size(), 1U) << "damage must be reported";
  EXPECT_EQ((*read)->history.attention[0].sentence,
            "a part of the run's stored map, tracks and plots is lost: damaged records: 1");
  read.reset();
  archive->read("7", [&](auto its) {
    read = its ? *its : nullptr;
    EXPECT_EQ(its.error().status, icd::Status::NotFound);
  });
  ASSERT_TRUE(loop::turn_until(loop, [&] { return read.has_value(); }));
  EXPECT_EQ(*read, nullptr);
}

TEST_F(ArchiveTest, StaysWithinTheWriteAllowance) {
  live(run.head);
  run.draw(100);  // some 4 kB each, and their coarser levels
  write();
  EXPECT_LT(stored(), Allowance::kMost + 4096);
  const auto before = stored();
  archive->write_now(run.seen());
  archive->write_now(run.seen());
  ASSERT_TRUE(loop::turn_until_idle(loop, archive->thread()));
  EXPECT_LT(stored() - before, 8192U) << "too much was written";
}

TEST_F(ArchiveTest, TellsWhyNothingIsStoredAndContinues) {
  std::ofstream(folder / "runs") << "a file where the folder should be";
  live(run.head);
  EXPECT_NE(archive->trouble(), "");
  write();
  EXPECT_EQ(archive->history(0).at.size(), 1U) << "plots must continue";
  EXPECT_NE(archive->trouble(), "");
}

TEST_F(ArchiveTest, StoresTheRunOnceTheDirectoryIsWritable) {
  std::ofstream(folder / "runs") << "a file where the folder should be";
  live(run.head);
  fs::remove(folder / "runs");
  archive->tick(run.seen());
  ASSERT_TRUE(loop::turn_until_idle(loop, archive->thread()));
  EXPECT_EQ(archive->trouble(), "");
  run.draw(3);
  write();
  live(run.head);
  EXPECT_EQ(shown(picture), shown(run.easel.mosaic));
}

}  // namespace
}  // namespace adit::archive
