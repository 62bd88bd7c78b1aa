#include "journal/journal.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "journal/left_in.hpp"
#include "loop/turn_until.hpp"
#include "project_files.hpp"

namespace adit::journal {
namespace {

namespace fs = std::filesystem;

std::vector<queues::PostedPose> pose(double x) {
  return {{*icd::RobotName::parse("r1"), {.position = {x, 0, 0}, .orientation = {}}, x, "10.0.0.5"}};
}

icd::MarkersUpdate one_marker(std::int32_t id, std::size_t text = 0) {
  icd::Marker marker;
  marker.header.stamp = 5;
  marker.ns = "path";
  marker.id = id;
  marker.text = std::string(text, 'x');
  return {.markers = {marker}};
}

class JournalTest : public testing::Test {
 protected:
  JournalTest() {
    std::string pattern = fs::temp_directory_path() / "adit-journal-XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
  }
  ~JournalTest() override { fs::remove_all(folder_); }

  /// A process that runs until it is dropped. A death is the same, because it has no work left.
  std::unique_ptr<Journal> life() {
    auto journal = std::make_unique<Journal>(loop_, folder_ / "journal");
    journal->begin({.boot = "b", .at = loop_.now(), .stamp = 1e9});
    return journal;
  }
  HandoverState left() const { return left_in(folder_ / "journal"); }
  std::vector<std::string> files(const std::string& kind) const {
    std::vector<std::string> names;
    for (const auto& file : fs::directory_iterator(folder_ / "journal")) {
      if (file.path().filename().string().starts_with(kind)) names.push_back(file.path());
    }
    return names;
  }
  /// Waits until there is one snapshot and one log.
  void wait_for_snapshot() {
    const auto is_done = [this] { return files("snapshot").size() == 1 && files("log-").size() == 1; };
    ASSERT_TRUE(loop::turn_until(loop_, is_done, std::chrono::seconds{60}));
  }

  loop::Loop loop_;
  fs::path folder_;
};

TEST_F(JournalTest, RestoresUndeliveredMessages) {
  {
    const auto journal = life();
    EXPECT_TRUE(journal->record_accepted(pose(1)));
    EXPECT_TRUE(journal->record_accepted(one_marker(1)));
    journal->record_markers_sent(one_marker(1));
    EXPECT_TRUE(journal->record_accepted(one_marker(2)));
    journal->record_markers_answered(true);
  }
  for (int lives = 0; lives < 3; ++lives) {
    SCOPED_TRACE(lives);
    EXPECT_EQ(left().robots().size(), 1u);
    EXPECT_EQ(left().markers(), one_marker(2));
    (void)life();
  }
}

/// Commit 937b95d6 wrote the journal.
TEST(JournalFiles, OfAnEarlierVersionAreRead) {
  using namespace std::chrono_literals;
  const HandoverState carried = left_in(project_file("tests/journal/earlier"));
  ASSERT_TRUE(carried.clock());
  const auto& [boot, at, stamp, step_to, step_by, off, off_since] = *carried.clock();
  EXPECT_EQ(std::tie(boot, at, stamp), std::tuple("b", pace::Instant(1000s), 1e9));
  EXPECT_EQ(std::tie(step_to, step_by, off, off_since), std::tuple(2, 3, 4, 5));

  std::vector<queues::PostedPose> poses;
  for (const auto& [name, robot] : carried.robots()) poses.push_back(robot.posted);
  const icd::Pose pose{.position = {1.5, -2, 1e-300}, .orientation = {0, 0, 0.6, 0.8}};
  EXPECT_THAT(poses,
              testing::ElementsAre(queues::PostedPose{*icd::RobotName::parse("r1"), pose, 12.25, "10.0.0.5"},
                                   queues::PostedPose{*icd::RobotName::parse("r2"), {}, {}, ""}));
  icd::Marker marker;
  marker.header.stamp = 6;
  marker.ns = "a";
  marker.id = -1;
  marker.type = 8;
  marker.pose = {.position = {1, 2, 3}, .orientation = {0.5, 0.5, 0.5, 0.5}};
  marker.scale = {1, 2, 3};
  marker.color = {0.1, 0.2, 0.3, 0.4};
  marker.lifetime = 7;
  marker.text = "text";
  marker.frame_locked = marker.mesh_use_embedded_materials = true;
  marker.points = {{1, 2, 3}, {4, 5, 6}};
  marker.colors = {{0.5, 0.25, 0.75, 1}};
  marker.mesh_resource = "package://a/b.stl";
  marker.expires = 13;
  EXPECT_THAT(carried.markers().markers, testing::ElementsAre(marker));

  const auto senders = carried.senders().clocks();
  ASSERT_EQ(senders.size(), 1U);
  EXPECT_EQ(senders[0].first, (queues::Stamper{"10.0.0.5", icd::Uri::MapUpdate, "r1"}));
  const auto& [theirs, ours, latest] = senders[0].second;
  EXPECT_EQ(std::tie(theirs, ours, latest), std::tuple(100, 200, 300));
  const pace::LearnedRate learned{.earliest = {pace::Instant(1001s), {}},
                                  .spacing = 2s,
                                  .under_way = true,
                                  .from_answers = true,
                                  .single = {}};
  EXPECT_THAT(carried.paces(), testing::ElementsAre(testing::Pair(icd::Uri::MapUpdate, learned)));
  EXPECT_THAT(carried.stamps(), testing::ElementsAre(testing::Pair(icd::Uri::StateUpdate, 1e9 + 1)));
  EXPECT_THAT(carried.grids(),
              testing::Optional(testing::ElementsAre(testing::Pair("g", queues::Extent{1, 2, 3, 4}))));
  ASSERT_EQ(carried.heard_by_robot().size(), 1U);
  const Heard& heard = carried.heard_by_robot().at("r1");
  EXPECT_EQ(std::tie(heard.messages, heard.gap, heard.last), std::tuple(9U, 0.5, 40));
  EXPECT_EQ(std::tie(heard.kinds[0].accepted, heard.kinds[0].forwarded), std::tuple(1, 2));
  EXPECT_TRUE(std::isnan(heard.kinds[1].accepted) && std::isnan(heard.kinds[1].forwarded));
  EXPECT_EQ(std::tie(heard.kinds[2].accepted, heard.kinds[2].forwarded), std::tuple(3, 4));
}

TEST_F(JournalTest, IsPrivate) {
  const auto journal = life();
  struct stat status{};
  ASSERT_EQ(::stat((folder_ / "journal").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0700u);
  ASSERT_EQ(::stat(files("log-").front().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
}

/// A kill within a write: answered messages are there, others may be missing, and no further ones appear.
TEST_F(JournalTest, HoldsAllAnsweredMessagesAfterAnyCut) {
  constexpr int kAnswered = 3;
  std::vector<std::uintmax_t> sizes;
  {
    const auto journal = life();
    const std::string file = files("log-").front();
    sizes.push_back(fs::file_size(file));
    for (int i = 1; i <= kAnswered; ++i) {
      ASSERT_TRUE(journal->record_accepted(pose(i)));
      ASSERT_TRUE(journal->record_accepted(one_marker(i)));
      sizes.push_back(fs::file_size(file));
    }
  }
  const std::string file = files("log-").front();
  std::ifstream stream(file, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    fs::remove(file);  // ext4 syncs a file that replaces another one's content
    std::ofstream(file, std::ios::binary) << whole.substr(0, cut);
    std::size_t answered = 0;
    while (answered + 1 < sizes.size() && sizes[answered + 1] <= cut) ++answered;
    const HandoverState carried = left();
    const auto markers = carried.markers().markers;
    ASSERT_EQ(markers.size(), answered) << "cut at " << cut;
    for (std::size_t i = 0; i < markers.size(); ++i) ASSERT_EQ(markers[i].id, static_cast<int>(i) + 1);
    const double x = carried.robots().empty() ? 0 : carried.robots().begin()->second.posted.pose.position.x;
    ASSERT_GE(x, static_cast<double>(answered));
    ASSERT_LE(x, static_cast<double>(answered) + 1) << "the message of the current write";
  }
}

TEST_F(JournalTest, ContinuesAfterATornRecord) {
  ASSERT_TRUE(life()->record_accepted(pose(1)));
  std::ofstream(files("log-").front(), std::ios::binary | std::ios::app) << "ADTL torn";
  ASSERT_TRUE(life()->record_accepted(one_marker(7)));
  EXPECT_EQ(left().markers(), one_marker(7));
  EXPECT_EQ(left().robots().size(), 1u);
}

/// The missing record may be a delivery, so known messages are queued again.
TEST_F(JournalTest, ReportsAMissingRecordAndDistrustsLaterDeliveries) {
  std::size_t at = 0;
  {
    const auto journal = life();
    ASSERT_TRUE(journal->record_accepted(one_marker(1)));
    at = fs::file_size(files("log-").front());
    ASSERT_TRUE(journal->record_accepted(pose(1)));
    journal->record_markers_sent(one_marker(1));
    journal->record_markers_answered(true);
    journal->record_markers_sent({});
  }
  std::fstream(files("log-").front(), std::ios::in | std::ios::out | std::ios::binary)
      .seekp(static_cast<std::streamoff>(at + 16))
      .put('x');
  Journal journal(loop_, folder_ / "journal");
  const HandoverState carried = journal.read();
  EXPECT_THAT(journal.damage(), testing::HasSubstr("records of the journal are missing: log-00000001"));
  EXPECT_EQ(carried.markers(), one_marker(1));
  EXPECT_TRUE(carried.robots().empty());
}

TEST_F(JournalTest, StaysSmallAndLosesNothingAtRestarts) {
  constexpr int kMarkers = 40;
  auto journal = life();
  for (int round = 0; round < 100; ++round) {
    for (int id = 0; id < kMarkers; ++id) {
      const icd::MarkersUpdate update = one_marker(id, 1000 + static_cast<std::size_t>(round));
      ASSERT_TRUE(journal->record_accepted(update));
    }
    loop_.turn(std::chrono::nanoseconds(0));
  }
  wait_for_snapshot();
  EXPECT_LT(fs::file_size(files("snapshot").front()), 4 * kMarkers * 1100u)
      << "the snapshot has only queued messages";
  const auto check = [&] {
    const auto markers = left().markers().markers;
    ASSERT_EQ(markers.size(), static_cast<std::size_t>(kMarkers));
    for (const icd::Marker& marker : markers) EXPECT_EQ(marker.text.size(), 1099u);
  };
  check();
  journal = nullptr;
  journal = life();
  check();
}

TEST_F(JournalTest, ChangesNothingIfAFileCannotBeRead) {
  ASSERT_TRUE(life()->record_accepted(pose(1)));
  const fs::path unreadable = folder_ / "journal" / "log-00000002.0123456789abcdef";
  fs::create_directory(unreadable);
  const std::string why = unreadable.string() + ": is not a regular file";
  {
    Journal journal(loop_, folder_ / "journal");
    EXPECT_TRUE(journal.read().robots().empty());
    EXPECT_EQ(journal.trouble(), why);
    journal.begin({.boot = "b", .at = loop_.now(), .stamp = 1e9});
    const auto kept = journal.record_accepted(pose(2));
    ASSERT_FALSE(kept);
    EXPECT_EQ(kept.error(), why);
    EXPECT_EQ(files("log-").size(), 2u) << "no new one";
    EXPECT_EQ(journal.unread(), why);
    EXPECT_FALSE(Journal::can_be_read(folder_ / "journal"));
  }
  fs::remove(unreadable);
  EXPECT_TRUE(Journal::can_be_read(folder_ / "journal"));
  EXPECT_TRUE(Journal::can_be_read(folder_ / "none"));
  EXPECT_EQ(left().robots().size(), 1u);
}

/// Limits the size of files, as a full directory does.
class NoRoom {
 public:
  explicit NoRoom(std::uintmax_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const struct rlimit small{bytes, before_.rlim_max};
    handler_ = ::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~NoRoom() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }
  NoRoom(const NoRoom&) = delete;
  NoRoom& operator=(const NoRoom&) = delete;

 private:
  struct rlimit before_{};
  sighandler_t handler_ = nullptr;
};

TEST_F(JournalTest, ReportsAFullDiskAndKeepsItsRecords) {
  const auto journal = life();
  ASSERT_TRUE(journal->record_accepted(one_marker(1)));
  const auto size = fs::file_size(files("log-").front());
  for (std::uintmax_t room = 0; room < 40; ++room) {
    const NoRoom none(size + room);
    const auto kept = journal->record_accepted(one_marker(2));
    ASSERT_FALSE(kept) << "with room for " << room << " bytes";
    EXPECT_THAT(kept.error(), testing::HasSubstr("journal: "));
    EXPECT_EQ(journal->trouble(), kept.error());
  }
  ASSERT_TRUE(journal->record_accepted(one_marker(3)));
  EXPECT_EQ(journal->trouble(), "");
  std::vector<std::int32_t> ids;
  for (const icd::Marker& marker : left().markers().markers) ids.push_back(marker.id);
  EXPECT_THAT(ids, testing::ElementsAre(1, 3));
}

/// Messages that the process before sent without a known answer are queued again. Times are read by the
/// clock of this boot.
TEST_F(JournalTest, RecordsTheStartOnceTheDiskHasRoom) {
  {
    const auto journal = life();
    ASSERT_TRUE(journal->record_accepted(one_marker(1)));
    journal->record_markers_sent(one_marker(1));
  }
  std::unique_ptr<Journal> journal;
  {
    const NoRoom none(1);
    journal = std::make_unique<Journal>(loop_, folder_ / "journal");
    journal->begin({.boot = "after", .at = loop_.now(), .stamp = 2e9});
    EXPECT_FALSE(journal->record_accepted(one_marker(2)));
  }
  ASSERT_TRUE(journal->record_accepted(one_marker(3)));
  journal->record_markers_answered(true);  // this process sent none
  journal = nullptr;
  std::vector<std::int32_t> ids;
  for (const icd::Marker& marker : left().markers().markers) ids.push_back(marker.id);
  EXPECT_THAT(ids, testing::ElementsAre(1, 3));
  EXPECT_EQ(left().clock()->boot, "after");
}

/// Otherwise a delivered DeleteAll would be sent again after later messages.
TEST_F(JournalTest, RecordsDeliveriesFirstOnceTheDiskHasRoom) {
  const auto journal = life();
  ASSERT_TRUE(journal->record_accepted(one_marker(1)));
  {
    const NoRoom none(1);
    journal->record_markers_sent(one_marker(1));
    journal->record_markers_answered(false);
    journal->record_markers_sent(one_marker(1));
    journal->record_markers_answered(true);
  }
  ASSERT_TRUE(journal->record_accepted(one_marker(2)));
  std::vector<std::int32_t> ids;
  for (const icd::Marker& marker : left().markers().markers) ids.push_back(marker.id);
  EXPECT_THAT(ids, testing::ElementsAre(2));
}

TEST_F(JournalTest, SkipsFailedSendsDuringAFullDisk) {
  const auto journal = life();
  ASSERT_TRUE(journal->record_accepted(one_marker(1)));
  {
    const NoRoom none(1);
    // Together more than the limit of unwritten records.
    icd::MarkersUpdate sent = one_marker(1);
    sent.markers.front().ns = std::string(Journal::kMostUnsaid / 3, 'n');
    for (int round = 0; round < 10; ++round) {
      journal->record_markers_sent(sent);
      journal->record_markers_answered(false);
    }
    journal->record_markers_sent(one_marker(1));
    journal->record_markers_answered(true);
  }
  journal->record_pace(icd::Uri::StateUpdate, {});
  EXPECT_TRUE(left().markers().markers.empty());
}

TEST_F(JournalTest, ReportsAnUnwritableDirectory) {
  std::ofstream(folder_ / "journal") << "";
  const auto journal = life();
  EXPECT_FALSE(journal->record_accepted(pose(1)));
  fs::remove(folder_ / "journal");
  fs::create_directory(folder_ / "journal");
  EXPECT_TRUE(journal->record_accepted(pose(1))) << "once the directory is writable";
}

/// The journal's cost per post. Printed, not asserted, because machines differ.
TEST_F(JournalTest, PrintsItsCostPerState) {
  const auto journal = life();
  constexpr int kPosts = 2000;
  std::vector<double> micros;
  for (int i = 0; i < kPosts; ++i) {
    const auto began = std::chrono::steady_clock::now();
    journal->record_senders(
        {{{"10.0.0.5", icd::Uri::StateUpdate, "r1"}, {.theirs = 1, .ours = 2, .latest = 3}}});
    ASSERT_TRUE(journal->record_accepted(pose(i)));
    micros.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - began).count());
  }
  std::ranges::sort(micros);
  std::printf("a state and its sender's clock in %s: p50 %.1f us, p99 %.1f us\n", folder_.c_str(),
              micros[kPosts / 2], micros[kPosts * 99 / 100]);
}

}  // namespace
}  // namespace adit::journal
