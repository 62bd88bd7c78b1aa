#include "forward/flow.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <mutex>

#include "../uplink/peer.hpp"
#include "host/folder.hpp"
#include "journal/left_in.hpp"
#include "loop/simulated_time.hpp"
#include "loop/turn_until.hpp"
#include "spool/bytes_read.hpp"
#include "spool/messages.hpp"

namespace adit::forward {
namespace {

using testing::ElementsAre;

icd::NamedPose at(const char* robot, double x) {
  return {*icd::RobotName::parse(robot), {{x, 0, 0}, {}}};
}

/// Without tokens, accepted messages stay queued.
class FlowTest : public testing::Test {
 protected:
  void SetUp() override { restart(); }
  void restart() {
    flow_.reset();
    flow_.emplace(loop_, ledger_, settings_,
                  Tokens{.scoring = {}, .mapping = {}, .all = {*icd::BearerToken::parse("a-secret")}},
                  Flow::Folders{folder_.path(), folder_.path()},
                  Flow::Callbacks{.on_changed = [] {},
                                  .on_posted = [this](const std::string& name) { posted_.push_back(name); }});
    flow_->start();
  }
  icd::Checked<void> take_map(icd::MapUpdate map = spool::cloud(3)) {
    std::optional<icd::Checked<void>> said;
    flow_->begin_map()->accept(std::move(map), sender_,
                               [&](icd::Checked<void> taken) { said = std::move(taken); });
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return said.has_value(); }));
    return said.value_or(std::unexpected(icd::Refusal{icd::Status::Ok, "nothing was said"}));
  }
  /// Few markers are answered at once.
  icd::Checked<void> take_markers() {
    std::optional<icd::Checked<void>> said;
    flow_->accept(spool::markers(), sender_, [&](icd::Checked<void> taken) { said = std::move(taken); });
    return said.value();
  }
  icd::Checked<void> take_poses(std::vector<icd::NamedPose> poses, double stamp) {
    return flow_->accept({.header = {stamp}, .poses = std::move(poses)}, sender_);
  }
  journal::HandoverState kept() const { return journal::left_in(folder_.path() + "/journal"); }
  double kept_x(const char* robot) const {
    return kept().robots().at(*icd::RobotName::parse(robot)).posted.pose.position.x;
  }
  std::vector<std::uint64_t> waiting() const {
    std::vector<std::uint64_t> waiting;
    for (const facts::ActivityRow& row : flow_->activities()) waiting.push_back(row.queued);
    return waiting;
  }

  const intake::Sender sender_{.address = "10.0.0.5", .bytes = 10};
  host::Folder folder_;
  loop::Loop loop_;
  settings::Settings settings_;
  ledger::Ledger ledger_ = std::move(*ledger::Ledger::open(folder_.path()));
  std::vector<std::string> posted_;
  std::optional<Flow> flow_;
};

TEST_F(FlowTest, KeepsQueuedMessagesAcrossARestart) {
  ASSERT_TRUE(take_map());
  ASSERT_TRUE(flow_->accept(spool::state(), sender_));
  ASSERT_TRUE(take_markers());
  EXPECT_THAT(waiting(), ElementsAre(1, 1, 1));
  restart();
  EXPECT_THAT(waiting(), ElementsAre(1, 1, 1));
}

TEST_F(FlowTest, GoesOnWithoutAMapThatCanNeverBeRead) {
  ASSERT_TRUE(take_map(spool::cloud(10)));
  const std::string file = folder_ / "waiting/map-00000001.cbor";
  std::filesystem::create_directory(file);
  restart();
  EXPECT_THAT(waiting(), ElementsAre(1)) << "the other map";
  EXPECT_EQ(flow_->put_aside(), file + ": cannot read " + file + ": is not a regular file");
  EXPECT_TRUE(flow_->has_read_messages());
  EXPECT_TRUE(take_map(spool::cloud(10)));
}

TEST_F(FlowTest, TellsThatRejectedMessagesCannotBeRead) {
  EXPECT_EQ(flow_->put_aside(), "");
  std::filesystem::create_directory(folder_ / "rejected/1.json");
  restart();
  EXPECT_EQ(flow_->put_aside(), "rejected messages cannot be read: cannot read " +
                                    folder_ / "rejected/1.json" + ": is not a regular file");
}

/// Listeners open after the start, so it must be short.
TEST_F(FlowTest, StartsWithoutReadingQueuedData) {
  ASSERT_TRUE(take_map(spool::cloud(1'000'000)));  // 12 MB
  const auto before = spool::BytesRead::of(folder_ / "waiting");
  restart();
  EXPECT_THAT(waiting(), ElementsAre(1));
  const auto after = spool::BytesRead::of(folder_ / "waiting");
  EXPECT_LT(after.by_calls - before.by_calls, 1'000'000U);
  EXPECT_GT(after.in_mappings, 0U) << "both ends of the file";
  EXPECT_LT(after.in_mappings, 1'000'000U);
}

TEST_F(FlowTest, ShowsSinceWhenTheCommandPostIsBehind) {
  const api::Time before = loop_.wall_now();
  ASSERT_TRUE(take_map());
  ASSERT_TRUE(flow_->accept(spool::state(), sender_));
  ASSERT_TRUE(take_markers());
  for (const facts::ActivityRow& row : flow_->activities()) {
    ASSERT_TRUE(row.behind_since) << row.kind;
    EXPECT_GE(*row.behind_since, before - 0.001) << row.kind;
    EXPECT_LE(*row.behind_since, loop_.wall_now() + 0.001) << row.kind;
  }
}

TEST_F(FlowTest, ReportsWhichRobotsPost) {
  ASSERT_TRUE(take_map());
  ASSERT_TRUE(flow_->accept(spool::state(), sender_));
  EXPECT_THAT(posted_, ElementsAre("r1", "r2"));
}

/// A station posts poses of one or several robots on one connection.
TEST_F(FlowTest, KeepsThePoseWithTheLatestStampOfAStation) {
  ASSERT_TRUE(take_poses({at("a", 0), at("b", 0)}, 100));
  loop_.set_stamp(loop_.stamp_now() + 2);
  ASSERT_TRUE(take_poses({at("a", 1)}, 101)) << "one second late";
  ASSERT_TRUE(take_poses({at("a", 5), at("b", 5)}, 101.5));
  EXPECT_EQ(kept_x("a"), 5);
}

TEST_F(FlowTest, KeepsTheLastPoseOfTwoAddresses) {
  const intake::Sender other{.address = "10.0.0.6", .bytes = 10};
  ASSERT_TRUE(take_poses({at("a", 0)}, 100));
  ASSERT_TRUE(take_poses({at("a", 1)}, 103)) << "its clock is ahead";
  ASSERT_TRUE(flow_->accept({.header = {50}, .poses = {at("a", 5)}}, other));
  EXPECT_EQ(kept_x("a"), 5);
}

TEST_F(FlowTest, QuotesNoToken) {
  flow_->on_rejected(icd::Uri::StateUpdate, sender_,
                     {icd::Status::UnprocessableEntity, "name: got a-secret", 0});
  ASSERT_EQ(flow_->counts().refusals().size(), 1);
  EXPECT_THAT(flow_->counts().refusals().front().sentence, testing::Not(testing::HasSubstr("a-secret")));
}

TEST_F(FlowTest, RecordsPartsAndSettingOfARejection) {
  flow_->on_rejected(icd::Uri::StateUpdate, sender_,
                     {icd::Status::UnprocessableEntity, "name: got x", 3, "robots[].alias"});
  ASSERT_EQ(flow_->counts().refusals().size(), 1);
  EXPECT_EQ(flow_->counts().refusals().front().parts, 3u);
  EXPECT_EQ(flow_->counts().refusals().front().setting, "robots[].alias");
}

TEST_F(FlowTest, EndsAndAcceptsNoActionOnRejectedMessages) {
  bool over = false;
  EXPECT_FALSE(flow_->is_ending());
  flow_->end([&] { over = true; });
  EXPECT_TRUE(flow_->is_ending());
  EXPECT_FALSE(flow_->change_rejected(1, api::RejectedAction::Discard));
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return over; }));
}

class FlowLedgerTest : protected loop::SimulatedTime, public FlowTest {
 protected:
  /// Advances time and waits for the disk.
  void tick(loop::Duration passed) {
    pass(passed);
    flow_->tick(disk_);
    ASSERT_TRUE(loop::turn_until_idle(loop_, disk_));
  }
  bool has(const std::string& beginning) const {
    const std::filesystem::directory_iterator files(folder_ / "ledger");
    return std::ranges::any_of(
        files, [&](const auto& file) { return file.path().filename().string().starts_with(beginning); });
  }

  loop::Writer disk_{loop_};
};

TEST_F(FlowLedgerTest, GetsASpareFileAndASnapshot) {
  tick(LedgerUpkeep::kEvery - std::chrono::seconds(1));
  EXPECT_FALSE(has("spare-"));
  tick(std::chrono::seconds(1));
  EXPECT_TRUE(has("spare-"));
  dispatch::Report report{.number = 1, .report = {"Backpack", {1, 2, 3}}, .sender = "10.0.0.7"};
  report.answer.resize(1u << 20);
  while (has("spare-")) ASSERT_TRUE(ledger_.write({&report, 1}));
  EXPECT_FALSE(has("snapshot-"));
  tick(std::chrono::seconds(1));
  EXPECT_TRUE(has("snapshot-"));
  tick(std::chrono::seconds(1));
  EXPECT_TRUE(has("spare-"));
  EXPECT_FALSE(ledger_.upkeep());
}

TEST_F(FlowLedgerTest, KeepsItsSizeInTheStampFloorIfUnreadable) {
  StampFloor(folder_.path()).write({.floor = 1, .ledger = {.reports = 7, .log = 3}});
  ledger_ = ledger::Ledger::make_closed("it cannot be read", {.reports = 7, .log = 3});
  restart();
  tick(std::chrono::seconds(10));
  const auto kept = StampFloor(folder_.path()).read();
  EXPECT_GT(kept->floor, 1);
  EXPECT_EQ(kept->ledger.reports, 7);
  EXPECT_EQ(kept->ledger.log, 3U);
}

/// The endpoint accepts each state.
class FlowWithAnEndpoint : public testing::Test {
 protected:
  FlowWithAnEndpoint() { settings_.command_post.mapping = {post_.endpoint().address, post_.endpoint().port}; }
  void sends(Flow& flow, const char* sender, double stamp, const char* robot) {
    const icd::StateUpdate update{.header = {stamp}, .poses = {at(robot, 0)}};
    const int before = states_;
    ASSERT_TRUE(flow.accept(update, {.address = sender}));
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return states_ > before; }));
  }
  std::string last() const {
    const std::scoped_lock lock(mutex_);
    return last_;
  }

  mutable std::mutex mutex_;
  std::string last_;
  std::atomic<int> states_ = 0;
  uplink::ListeningPeer post_{std::vector<uplink::Peer::Script>(1, [this](uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      {
        const std::scoped_lock lock(mutex_);
        last_ = request;
      }
      ++states_;
      if (!wire.write(uplink::answer("200 OK", "null"))) return;
    }
  })};
  host::Folder folder_;
  loop::Loop loop_;
  settings::Settings settings_;
  ledger::Ledger ledger_ = std::move(*ledger::Ledger::open(folder_.path()));
};

TEST_F(FlowWithAnEndpoint, RepeatsOnlyPosesOfTheRun) {
  Flow flow(loop_, ledger_, settings_,
            {.scoring = {}, .mapping = icd::BearerToken::parse("a-token"), .all = {}},
            {folder_.path(), folder_.path()}, {.on_changed = [] {}, .on_posted = [](const std::string&) {}});
  flow.start();
  sends(flow, "10.0.0.5", 50, "was_here");
  sends(flow, "10.0.0.6", 50, "goes_on");
  EXPECT_THAT(last(), testing::HasSubstr("was_here"));
  flow.begin_run();
  sends(flow, "10.0.0.6", 52, "goes_on");
  EXPECT_THAT(last(), testing::Not(testing::HasSubstr("was_here")));
}

}  // namespace
}  // namespace adit::forward
