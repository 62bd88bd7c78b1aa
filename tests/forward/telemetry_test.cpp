#include "forward/telemetry.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../uplink/peer.hpp"
#include "host/folder.hpp"
#include "journal/left_in.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::vector<queues::PostedPose> pose(const char* robot, double stamp) {
  return {{*icd::RobotName::parse(robot), {}, stamp, "10.0.0.5"}};
}

icd::Marker marker(const char* ns, const char* text, icd::MarkerAction action = icd::MarkerAction::Add) {
  icd::Marker made;
  made.header.stamp = 5;
  made.ns = ns;
  made.text = text;
  made.action = action;
  return made;
}

std::vector<std::string> texts(const icd::MarkersUpdate& update) {
  std::vector<std::string> all;
  for (const icd::Marker& each : update.markers) all.push_back(each.text);
  return all;
}

const icd::Marker kWipe = marker("", "wipe", icd::MarkerAction::DeleteAll);

/// Telemetry and its surroundings in one process.
struct Process {
  Process(loop::Loop& loop, const std::string& folder, const settings::Settings& settings,
          std::optional<icd::BearerToken> token)
      : servers(loop),
        writer(loop),
        workers(loop, 1),
        journal(loop, folder + "/journal"),
        rejected(loop, writer, folder + "/rejected"),
        telemetry(loop, servers, workers, settings, std::move(token), counts, rejected, random, journal,
                  delivered) {
    const journal::HandoverState carried = journal.read();
    journal.begin({.boot = "b", .at = loop.now(), .stamp = loop.stamp_now()});
    telemetry.restore(carried);
    telemetry.start();
  }

  /// Few markers are answered at once.
  icd::Checked<void> accept(icd::MarkersUpdate update) {
    std::optional<icd::Checked<void>> said;
    telemetry.accept(std::move(update), {.bytes = 10},
                     [&](icd::Checked<void> taken) { said = std::move(taken); });
    return said.value();
  }

  std::mt19937_64 random{1};
  TrafficCounts counts{[] {}};
  uplink::Servers servers;
  loop::Writer writer;
  loop::Workers workers;
  journal::Journal journal;
  RejectedStore rejected;
  DeliveredScene delivered;
  Telemetry telemetry;
};

class TelemetryTest : public testing::Test {
 protected:
  TelemetryTest() { settings_.command_post.rates.markers_hz = settings_.command_post.rates.state_hz = 50; }

  /// Accepted messages stay queued.
  std::unique_ptr<Process> process_without_a_token() {
    return std::make_unique<Process>(loop_, folder_.path(), settings_, std::nullopt);
  }
  std::unique_ptr<Process> process_with(const uplink::Peer& post) {
    settings_.command_post.mapping = {post.endpoint().address, post.endpoint().port};
    return std::make_unique<Process>(loop_, folder_.path(), settings_, icd::BearerToken::parse("a-token"));
  }
  /// Retries without a delay after failures.
  template <class Done>
  bool eventually(Process& process, Done done) {
    return loop::turn_until(loop_, [&] {
      if (done()) return true;
      process.telemetry.on_link_up();
      return false;
    });
  }
  journal::HandoverState left() const { return journal::left_in(folder_.path() + "/journal"); }

  host::Folder folder_;
  loop::Loop loop_;
  settings::Settings settings_;
};

/// Accepts each message except a delete-all, or none.
struct TelemetryStub {
  explicit TelemetryStub(bool takes_others)
      : peer([this, takes_others](uplink::Wire& wire) {
          for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
            ++requests;
            const bool takes = takes_others && request.find("wipe") == std::string::npos;
            if (!wire.write(uplink::answer(takes ? "200 OK" : "500 Oops", "null"))) return;
          }
        }) {}
  std::atomic<int> requests = 0;
  uplink::ListeningPeer peer;
};

TEST_F(TelemetryTest, KeepsNoDeliveredPoseAcrossARestart) {
  TelemetryStub post(true);
  auto process = process_with(post.peer);
  ASSERT_TRUE(process->telemetry.accept(pose("r1", 1), 10));
  ASSERT_TRUE(eventually(*process, [&] { return !process->delivered.robots().empty(); }));
  process.reset();
  process = process_without_a_token();
  EXPECT_EQ(process->telemetry.waiting(TrafficKind::State), 0u);
  ASSERT_TRUE(process->telemetry.accept(pose("r2", 2), 10));
  ASSERT_EQ(left().robots().size(), 1u);
  EXPECT_EQ(left().robots().begin()->first.text(), "r2");
}

TEST_F(TelemetryTest, KeepsTheAgeOfAPoseOverARestart) {
  auto process = process_without_a_token();
  ASSERT_TRUE(process->telemetry.accept(pose("r1", 1), 10));
  journal::Heard heard{.robot = "r1"};
  heard.behind[static_cast<std::size_t>(TrafficKind::State)] = loop_.stamp_now() - 30;
  process->journal.record_heard(heard);
  process.reset();
  process = process_without_a_token();
  const auto since = process->telemetry.oldest_acceptance({TrafficKind::State, "r1"});
  ASSERT_TRUE(since);
  EXPECT_NEAR(std::chrono::duration<double>(loop_.now() - *since).count(), 30, 5);
}

/// The pose may be of the last run.
TEST_F(TelemetryTest, SendsARestoredPoseOnce) {
  std::atomic<int> of_r1 = 0, of_r2 = 0;
  const uplink::ListeningPeer peer([&](uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      if (request.find("r1") != std::string::npos) ++of_r1;
      if (!wire.write(uplink::answer("200 OK", "null"))) return;
      if (request.find("r2") != std::string::npos) ++of_r2;
    }
  });
  ASSERT_TRUE(process_without_a_token()->telemetry.accept(pose("r1", 1), 10));
  const auto process = process_with(peer);
  ASSERT_TRUE(eventually(*process, [&] { return process->delivered.robots().size() == 1; }));
  ASSERT_TRUE(process->telemetry.accept(pose("r2", 2), 10));
  ASSERT_TRUE(eventually(*process, [&] { return of_r2 == 1; }));
  EXPECT_EQ(of_r1, 1);
}

/// A kill in between would otherwise let an operator send the older one.
TEST_F(TelemetryTest, KeepsMessagesUntilReplacementsAreStored) {
  TelemetryStub post(true);
  const auto process = process_with(post.peer);
  process->rejected.add(icd::StateUpdate{.header = {1}, .poses = {pose("r1", 1).at(0).to_named_pose()}}, 422,
                        "no", 100, {});
  process->rejected.add(icd::MarkersUpdate{{marker("a", "older")}}, 422, "no", 100, {});
  std::promise<void> held;
  process->writer.submit([until = held.get_future().share()] { until.wait(); }, [] {});
  const auto replaced = [&](std::size_t row) { return process->rejected.rows().at(row).replaced; };
  ASSERT_TRUE(process->telemetry.accept(pose("r1", 2), 10));
  ASSERT_TRUE(eventually(*process, [&] { return replaced(0); }));
  EXPECT_EQ(left().robots().size(), 1u);
  EXPECT_FALSE(process->rejected.has_stored_all());
  ASSERT_TRUE(process->accept(icd::MarkersUpdate{{marker("a", "newer")}}));
  held.set_value();
  ASSERT_TRUE(eventually(*process, [&] { return replaced(1) && process->rejected.has_stored_all(); }));
  EXPECT_THAT(left().robots(), IsEmpty());
  EXPECT_THAT(left().markers().markers, IsEmpty());
}

TEST_F(TelemetryTest, RetriesNoMarkerThatANewerOneReplaces) {
  const auto process = process_without_a_token();
  ASSERT_TRUE(process->accept(icd::MarkersUpdate{{marker("a", "newer"), marker("b", "other")}}));
  EXPECT_TRUE(process->telemetry.resend(icd::MarkersUpdate{{marker("a", "older")}}));
  EXPECT_THAT(texts(left().markers()), ElementsAre("newer", "other"));
  EXPECT_EQ(process->telemetry.waiting(TrafficKind::Markers), 2u);
}

TEST_F(TelemetryTest, RetriesNoMarkerThatWasDeleted) {
  const auto process = process_without_a_token();
  ASSERT_TRUE(process->accept(icd::MarkersUpdate{{kWipe}}));
  EXPECT_TRUE(process->telemetry.resend(icd::MarkersUpdate{{marker("a", "older")}}));
  EXPECT_THAT(texts(left().markers()), ElementsAre("wipe"));
  EXPECT_EQ(process->telemetry.waiting(TrafficKind::Markers), 1u);
}

TEST_F(TelemetryTest, RetriesADeleteAllBeforeNewerMarkers) {
  const auto process = process_without_a_token();
  ASSERT_TRUE(process->accept(icd::MarkersUpdate{{marker("", "newer")}}));
  EXPECT_TRUE(process->telemetry.resend(icd::MarkersUpdate{{kWipe}}));
  EXPECT_THAT(texts(left().markers()), ElementsAre("wipe", "newer"));
  EXPECT_EQ(process->telemetry.waiting(TrafficKind::Markers), 2u);
}

TEST_F(TelemetryTest, RetriesAMarkerThatNothingReplaces) {
  const auto process = process_without_a_token();
  ASSERT_TRUE(process->accept(icd::MarkersUpdate{{marker("b", "other")}}));
  EXPECT_TRUE(process->telemetry.resend(icd::MarkersUpdate{{marker("a", "older")}}));
  EXPECT_THAT(texts(left().markers()), UnorderedElementsAre("older", "other"));
}

TEST_F(TelemetryTest, RejectsADeleteAllThatFailsAlone) {
  TelemetryStub post(true);
  const auto process = process_with(post.peer);
  ASSERT_TRUE(process->accept(icd::MarkersUpdate{{kWipe, marker("a", "1"), marker("b", "2")}}));
  ASSERT_TRUE(eventually(*process, [&] { return process->telemetry.waiting(TrafficKind::Markers) == 0; }));
  ASSERT_TRUE(eventually(
      *process, [&] { return !process->rejected.rows().empty() && left().markers().markers.empty(); }));
  EXPECT_EQ(process->rejected.rows().size(), 1u);
  EXPECT_EQ(process->delivered.markers().changes(0).markers.size(), 2u);
}

TEST_F(TelemetryTest, KeepsADeleteAllIfEverythingFails) {
  TelemetryStub post(false);
  const auto process = process_with(post.peer);
  const icd::MarkersUpdate all{{kWipe, marker("a", "1"), marker("b", "2")}};
  ASSERT_TRUE(process->accept(all));
  ASSERT_TRUE(eventually(*process, [&] { return post.requests >= 20; }));
  EXPECT_THAT(process->rejected.rows(), IsEmpty());
  EXPECT_THAT(texts(left().markers()), ElementsAre("wipe", "1", "2"));
}

TEST_F(TelemetryTest, ChangesQueuedMarkersInAFullQueue) {
  settings_.queues.marker_bytes = 2 * icd::bytes_of(marker("a", "old"));
  const auto process = process_without_a_token();
  ASSERT_TRUE(process->accept(icd::MarkersUpdate{{marker("a", "old")}}));
  const auto said = process->accept(icd::MarkersUpdate{{marker("b", "new"), marker("a", "now")}});
  ASSERT_FALSE(said);
  EXPECT_EQ(said.error().status, icd::Status::TooManyRequests);
  EXPECT_EQ(said.error().parts, 1u) << said.error().sentence;
  EXPECT_EQ(said.error().setting, "queues.marker_bytes");
  EXPECT_EQ(left().markers().markers, std::vector{marker("a", "now")});
  const auto none = process->accept(icd::MarkersUpdate{{marker("b", "new")}});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().parts, 0u) << none.error().sentence;
  EXPECT_EQ(none.error().setting, "queues.marker_bytes");
}

TEST_F(TelemetryTest, CountsALifetimeOverARestart) {
  icd::Marker lasting = marker("a", "lasting"), expired = marker("b", "expired");
  lasting.lifetime = 100, expired.lifetime = 30;
  ASSERT_TRUE(process_without_a_token()->accept(icd::MarkersUpdate{{lasting, expired}}));
  loop_.set_stamp(loop_.stamp_now() + 40);
  TelemetryStub post(true);
  const auto process = process_with(post.peer);
  ASSERT_TRUE(eventually(*process, [&] { return process->telemetry.waiting(TrafficKind::Markers) == 0; }));
  const auto shown = [&] { return process->delivered.markers().changes(0).markers; };
  ASSERT_TRUE(eventually(*process, [&] { return !shown().empty(); }));
  ASSERT_EQ(shown().size(), 1u);
  EXPECT_EQ(shown()[0].marker.ns, "a");
  EXPECT_LE(shown()[0].marker.lifetime, 60);
  EXPECT_GT(shown()[0].marker.lifetime, 30);
}

TEST_F(TelemetryTest, IsBehindUntilItIsDelivered) {
  TelemetryStub post(true);
  const auto process = process_with(post.peer);
  const Traffic robot{TrafficKind::State, "r2"}, other{TrafficKind::State, "r9"},
      markers{TrafficKind::Markers, ""};
  EXPECT_FALSE(process->telemetry.oldest_acceptance(robot));
  ASSERT_TRUE(process->telemetry.accept(pose("r2", 7.5), 10));
  ASSERT_TRUE(process->accept(icd::MarkersUpdate{{marker("", "one")}}));
  EXPECT_TRUE(process->telemetry.oldest_acceptance(robot));
  EXPECT_TRUE(process->telemetry.oldest_acceptance(markers));
  EXPECT_FALSE(process->telemetry.oldest_acceptance(other)) << "it posted nothing";
  EXPECT_TRUE(eventually(*process, [&] {
    return !process->telemetry.oldest_acceptance(robot) && !process->telemetry.oldest_acceptance(markers);
  }));
  EXPECT_EQ(process->counts.rows().at(robot).forwarded, 1u);
}

/// Rejects each state with one of these robots.
struct RejectingStub {
  RejectingStub(std::string with, std::vector<std::string> names)
      : status(std::move(with)), robots(std::move(names)), peer([this](uplink::Wire& wire) {
          for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
            const bool accepts = std::ranges::none_of(
                robots, [&](const std::string& robot) { return rejects && request.contains(robot); });
            ++(accepts ? accepted : rejected);
            if (!wire.write(uplink::answer(accepts ? "200 OK" : status, "null"))) return;
          }
        }) {}
  const std::string status;
  const std::vector<std::string> robots;
  std::atomic<bool> rejects = true;
  std::atomic<int> accepted = 0, rejected = 0;
  uplink::ListeningPeer peer;
};

class OneRejectedRobot : public TelemetryTest, public testing::WithParamInterface<const char*> {};

TEST_P(OneRejectedRobot, FailsAlone) {
  RejectingStub post(GetParam(), {"r5"});
  const auto process = process_with(post.peer);
  const auto row = [&](const char* robot) { return process->counts.rows().at({TrafficKind::State, robot}); };
  double stamp = 1;
  ASSERT_TRUE(process->telemetry.accept(pose("r5", stamp), 10));
  ASSERT_TRUE(eventually(*process, [&] {
    EXPECT_TRUE(process->telemetry.accept(pose("r1", ++stamp), 10));
    return row("r5").last_sentence.contains("Adit tries this one again within 60 s");
  }));
  EXPECT_THAT(row("r5").last_sentence, testing::StartsWith("the Command Post answered"));
  EXPECT_GE(row("r1").forwarded, 1u);
  EXPECT_THAT(process->rejected.rows(), IsEmpty());
  EXPECT_TRUE(process->telemetry.oldest_acceptance({TrafficKind::State, "r5"}));

  post.rejects = false;
  process->telemetry.on_endpoint_changed(icd::BearerToken::parse("another-token"));
  EXPECT_TRUE(eventually(*process, [&] { return row("r5").forwarded == 1; })) << "it rests no longer";
}
INSTANTIATE_TEST_SUITE_P(, OneRejectedRobot,
                         testing::Values("401 Unauthorized", "403 Forbidden", "404 Not Found", "409 Conflict",
                                         "415 Unsupported Media Type", "500 Oops", "501 Not Implemented",
                                         "503 Service Unavailable"),
                         [](const auto& test) { return std::string(test.param).substr(0, 3); });

TEST_F(TelemetryTest, DeliversMarkersBesideARejectedOne) {
  RejectingStub post("403 Forbidden", {"bad"});
  const auto process = process_with(post.peer);
  ASSERT_TRUE(process->accept(icd::MarkersUpdate{{marker("a", "1"), marker("b", "bad"), marker("c", "2")}}));
  const auto shown = [&] { return process->delivered.markers().changes(0).markers.size(); };
  ASSERT_TRUE(eventually(
      *process, [&] { return shown() == 2 && process->telemetry.waiting(TrafficKind::Markers) == 1; }));
  EXPECT_THAT(process->rejected.rows(), IsEmpty());
  post.rejects = false;
  EXPECT_TRUE(eventually(*process, [&] { return shown() == 3; }));
}

/// A wrong token, or a server that is down.
TEST_F(TelemetryTest, SendsAllRobotsTogetherAfterAllWereRejected) {
  RejectingStub post("401 Unauthorized", {"r1", "r2", "r3"});
  const auto process = process_with(post.peer);
  for (const char* robot : {"r1", "r2", "r3"}) ASSERT_TRUE(process->telemetry.accept(pose(robot, 1), 10));
  ASSERT_TRUE(eventually(*process, [&] { return post.rejected >= 12; }));
  EXPECT_NE(process->telemetry.channel().trouble(), "");
  post.rejects = false;
  ASSERT_TRUE(eventually(*process, [&] { return process->delivered.robots().size() == 3; }));
  EXPECT_EQ(post.accepted, 2) << "one robot, then all others";
}

/// Counts, age and track follow the robot's own posts.
TEST_F(TelemetryTest, CountsNoRepeatedPoseAsForwarded) {
  TelemetryStub post(true);
  const auto process = process_with(post.peer);
  const Traffic silent{TrafficKind::State, "r1"}, other{TrafficKind::State, "r2"};
  const auto forwarded = [&](const Traffic& of) {
    const auto row = process->counts.rows().find(of);
    return row == process->counts.rows().end() ? 0 : row->second.forwarded;
  };
  ASSERT_TRUE(process->telemetry.accept(pose("r1", 1), 10));
  ASSERT_TRUE(eventually(*process, [&] { return forwarded(silent) == 1; }));
  const auto last = process->counts.rows().at(silent).last_forwarded;
  const api::Time seen = process->delivered.robots().at(0).at.value();
  for (std::uint64_t i = 1; i <= 3; ++i) {
    ASSERT_TRUE(process->telemetry.accept(pose("r2", static_cast<double>(i)), 10));
    ASSERT_TRUE(eventually(*process, [&] { return forwarded(other) == i; }));
  }
  EXPECT_EQ(forwarded(silent), 1u);
  EXPECT_EQ(process->counts.rows().at(silent).last_forwarded, last);
  EXPECT_EQ(process->delivered.robots().at(0).at, seen);
}

/// Nor as throttled or rejected.
TEST_F(TelemetryTest, BlamesOnlyRobotsWithANewPose) {
  TelemetryStub post(true);
  const auto process = process_with(post.peer);
  ASSERT_TRUE(process->telemetry.accept(pose("r1", 1), 10));
  ASSERT_TRUE(eventually(*process, [&] {
    return process->telemetry.waiting(TrafficKind::State) == 0 && !process->telemetry.channel().busy();
  }));
  ASSERT_TRUE(process->telemetry.accept(pose("wipe", 2), 10));  // rejected by the endpoint
  ASSERT_TRUE(eventually(
      *process, [&] { return process->counts.rows().at({TrafficKind::State, "wipe"}).failed >= 1; }));
  EXPECT_EQ(process->counts.rows().at({TrafficKind::State, "r1"}).failed, 0u);
}

}  // namespace
}  // namespace adit::forward
