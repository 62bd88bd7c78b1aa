#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "journal/journal.hpp"
#include "queues/merged.hpp"

namespace adit::journal {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

std::vector<queues::PostedPose> state(const char* name, double x, double stamp) {
  return {{*icd::RobotName::parse(name), {.position = {x, 0, 0}, .orientation = {}}, stamp, "10.0.0.5"}};
}

icd::Marker marker(const std::string& ns, std::int32_t id, icd::MarkerAction action, double x) {
  icd::Marker made;
  made.header.stamp = 5.0 + x;
  made.ns = ns;
  made.id = id;
  made.action = action;
  made.pose.position.x = x;
  return made;
}

void apply(HandoverState& carried, RecordKind kind, const std::string& said = {}) {
  ASSERT_TRUE(carried.apply(kind, said)) << static_cast<int>(kind);
}

std::string sent(std::initializer_list<const char*> robots) {
  std::vector<icd::RobotName> names;
  for (const char* robot : robots) names.push_back(*icd::RobotName::parse(robot));
  return store::bytes_of(names);
}

std::vector<std::string> names_in(const HandoverState& carried) {
  std::vector<std::string> names;
  for (const auto& [name, robot] : carried.robots()) names.push_back(name.text());
  return names;
}

/// The state that a later process reads from a snapshot.
HandoverState again(const HandoverState& carried) {
  HandoverState other;
  carried.write([&](RecordKind kind, std::string_view said) { ASSERT_TRUE(other.apply(kind, said)); });
  return other;
}

TEST(CarriedState, KeepsPosesUntilDelivered) {
  HandoverState carried;
  apply(carried, RecordKind::Poses, store::bytes_of(state("r1", 1, 10)));
  apply(carried, RecordKind::Poses, store::bytes_of(state("r2", 2, 11)));
  EXPECT_THAT(names_in(carried), ElementsAre("r1", "r2"));
  apply(carried, RecordKind::StateSent, sent({"r1", "r2"}));
  EXPECT_THAT(names_in(again(carried)), ElementsAre("r1", "r2")) << "the state was not answered";
  apply(carried, RecordKind::StateDone);
  EXPECT_THAT(carried.robots(), IsEmpty()) << "the next process may serve another Command Post";
}

TEST(CarriedState, KeepsPosesUnchanged) {
  const icd::Pose pose{.position = {1.5, -2, 1e-300}, .orientation = {0, 0, 0.6, 0.8}};
  const icd::RobotName name = *icd::RobotName::parse("r1");
  for (const queues::PostedPose& posted :
       {queues::PostedPose{name, pose, 12.25, "10.0.0.5"}, queues::PostedPose{name, pose, {}, ""}}) {
    HandoverState carried;
    apply(carried, RecordKind::Poses, store::bytes_of(std::vector{posted}));
    carried = again(carried);
    ASSERT_THAT(carried.robots(), SizeIs(1));
    EXPECT_EQ(carried.robots().begin()->second.posted, posted);
  }
}

TEST(CarriedState, SkipsTruncatedAndNamelessPoses) {
  HandoverState carried;
  const std::string poses = store::bytes_of(state("r1", 1, 10));
  for (std::size_t size = 0; size < poses.size(); ++size)
    EXPECT_FALSE(carried.apply(RecordKind::Poses, poses.substr(0, size))) << size;
  using Posed = std::tuple<std::string, std::string, std::optional<icd::Stamp>, icd::Pose>;
  const std::vector<Posed> all{{"r1", "", {}, {}}, {"no name", "", {}, {}}};
  EXPECT_FALSE(carried.apply(RecordKind::Poses, store::bytes_of(all)));
  EXPECT_THAT(carried.robots(), IsEmpty());
}

TEST(CarriedState, KeepsQueuedPosesIfOthersAreDelivered) {
  HandoverState carried;
  apply(carried, RecordKind::Poses, store::bytes_of(state("r1", 1, 10)));
  apply(carried, RecordKind::Poses, store::bytes_of(state("r2", 2, 11)));
  apply(carried, RecordKind::StateSent, sent({"r1"}));
  carried = again(carried);
  apply(carried, RecordKind::StateDone);
  EXPECT_THAT(names_in(carried), ElementsAre("r2"));
}

TEST(CarriedState, KeepsPosesReceivedDuringASend) {
  HandoverState carried;
  apply(carried, RecordKind::Poses, store::bytes_of(state("r1", 1, 10)));
  apply(carried, RecordKind::StateSent, sent({"r1"}));
  apply(carried, RecordKind::Poses, store::bytes_of(state("r1", 2, 11)));
  carried = again(carried);
  apply(carried, RecordKind::StateDone);
  ASSERT_THAT(carried.robots(), SizeIs(1));
  EXPECT_EQ(carried.robots().begin()->second.posted.pose.position.x, 2);
}

TEST(CarriedState, ResendsMessagesInFlightAtARestart) {
  HandoverState carried;
  apply(carried, RecordKind::Poses, store::bytes_of(state("r1", 1, 10)));
  apply(carried, RecordKind::Markers,
        store::bytes_of(std::vector{marker("a", 1, icd::MarkerAction::Add, 1)}));
  apply(carried, RecordKind::StateSent, sent({"r1"}));
  apply(carried, RecordKind::MarkersSent, names_of(std::vector{marker("a", 1, icd::MarkerAction::Add, 1)}));
  apply(carried, RecordKind::LifeBegins);
  apply(carried, RecordKind::StateDone);  // of the next process, in which no state is in flight
  apply(carried, RecordKind::MarkersDone);
  EXPECT_THAT(carried.robots(), SizeIs(1));
  EXPECT_THAT(carried.markers().markers, SizeIs(1));
}

TEST(CarriedState, ResendsMessagesWhoseAnswerWasNotRecorded) {
  HandoverState carried;
  apply(carried, RecordKind::Poses, store::bytes_of(state("r1", 1, 10)));
  apply(carried, RecordKind::Poses, store::bytes_of(state("r2", 1, 10)));
  const auto a = marker("a", 1, icd::MarkerAction::Add, 1), b = marker("b", 1, icd::MarkerAction::Add, 1);
  apply(carried, RecordKind::Markers, store::bytes_of(std::vector{a, b}));
  apply(carried, RecordKind::StateSent, sent({"r1"}));
  apply(carried, RecordKind::StateSent, sent({"r2"}));
  apply(carried, RecordKind::MarkersSent, names_of(std::vector{a}));
  apply(carried, RecordKind::MarkersSent, names_of(std::vector{b}));
  apply(carried, RecordKind::StateDone);
  apply(carried, RecordKind::MarkersDone);
  EXPECT_THAT(names_in(carried), ElementsAre("r1"));
  EXPECT_THAT(carried.markers().markers, ElementsAre(a));
}

TEST(CarriedState, KeepsEachMemberOfAMarker) {
  icd::Marker each = marker("a", -1, icd::MarkerAction::Add, 1);
  each.type = 8;
  each.pose.orientation = {0.5, 0.5, 0.5, 0.5};
  each.scale = {1, 2, 3};
  each.color = {0.1, 0.2, 0.3, 0.4};
  each.lifetime = 7;
  each.expires = 1007;
  each.text = "text";
  each.frame_locked = true;
  each.points = {{1, 2, 3}, {4, 5, 6}};
  each.colors = {{0.5, 0.6, 0.7, 0.8}};
  each.mesh_resource = "package://mesh";
  each.mesh_use_embedded_materials = true;
  icd::Marker unstamped = marker("b", 2, icd::MarkerAction::Delete, 0);
  unstamped.header.stamp.reset();
  HandoverState carried;
  apply(carried, RecordKind::Markers, store::bytes_of(std::vector{each, unstamped}));
  EXPECT_THAT(again(carried).markers().markers, ElementsAre(each, unstamped));
}

TEST(CarriedState, KeepsClocksPacesAndStamps) {
  using std::chrono::seconds;
  const pace::LearnedRate learned{
      .earliest = {.first = pace::Instant(seconds(7)), .last = pace::Instant(seconds(8))},
      .spacing = seconds(3),
      .under_way = true,
      .from_answers = true,
      .single = 2};
  const queues::Stamper r1{"10.0.0.5", icd::Uri::StateUpdate, "r1"},
      r2{"10.0.0.5", icd::Uri::MapUpdate, "r2"};
  HandoverState carried;
  EXPECT_FALSE(carried.clock());
  apply(carried, RecordKind::Clock,
        store::bytes_of(Clock{.boot = "b1", .at = pace::Instant(seconds(5)), .stamp = 1.5e9}));
  apply(carried, RecordKind::Senders,
        store::bytes_of(queues::StampShift::Clocks{{r1, {.theirs = 100, .ours = 1.5e9, .latest = 104}},
                                                   {r2, {.theirs = 7, .ours = 1.5e9, .latest = 8}}}));
  apply(carried, RecordKind::Pace, store::bytes_of(icd::Uri::MapUpdate, learned));
  apply(carried, RecordKind::Stamp, store::bytes_of(icd::Uri::StateUpdate, 1.5e9 + 4));
  for (const HandoverState& each : {carried, again(carried)}) {
    EXPECT_EQ(each.clock()->boot, "b1");
    EXPECT_EQ(each.clock()->at, pace::Instant(seconds(5)));
    EXPECT_EQ(each.clock()->stamp, 1.5e9);
    EXPECT_THAT(each.paces(), ElementsAre(Pair(icd::Uri::MapUpdate, learned)));
    EXPECT_THAT(each.stamps(), ElementsAre(Pair(icd::Uri::StateUpdate, 1.5e9 + 4)));
    ASSERT_THAT(each.senders().clocks(), ElementsAre(Pair(r2, testing::_), Pair(r1, testing::_)));
    EXPECT_EQ(each.senders().clocks()[0].second.latest_given(), 1.5e9 + 1);
    EXPECT_EQ(each.senders().clocks()[1].second.latest_given(), 1.5e9 + 4);
  }
  apply(carried, RecordKind::Clock,
        store::bytes_of(Clock{.boot = "b2", .at = pace::Instant(seconds(1)), .stamp = 1.6e9}));
  EXPECT_THAT(carried.paces(), IsEmpty()) << "times of another boot";
  EXPECT_THAT(carried.senders().clocks(), IsEmpty());
  EXPECT_THAT(carried.stamps(), SizeIs(1));
}

/// Steps of clocks are recorded. Each other stamp of a state is in its poses.
TEST(CarriedState, KeepsTheClocksOfStates) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> step{-5000, 5000};
  queues::StampShift live;
  HandoverState carried;
  std::map<std::string, double> theirs;  // by address
  for (int i = 0; i < 2000; ++i) {
    const std::string address = "10.0.0." + std::to_string(i % 3);
    const std::string robot = "r" + std::to_string(random() % 70);  // more clocks than an address may have
    const double stamp = theirs[address] = std::max(1.0, theirs[address] + step(random) + 1.5);
    const icd::Stamp ours = live.shift({address, icd::Uri::StateUpdate, robot}, stamp, 1.5e9 + i * 0.5);
    if (const auto changed = live.take_changed(); !changed.empty())
      apply(carried, RecordKind::Senders, store::bytes_of(changed));
    const std::vector<queues::PostedPose> poses{{*icd::RobotName::parse(robot), {}, ours, address}};
    apply(carried, RecordKind::Poses, store::bytes_of(std::span(poses)));
    if (i % 100 == 50) carried = again(carried);
  }
  const auto expected = live.clocks(), found = carried.senders().clocks();
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].first, expected[i].first);
    EXPECT_EQ(found[i].second.ours, expected[i].second.ours);
    EXPECT_EQ(found[i].second.theirs, expected[i].second.theirs);
    EXPECT_NEAR(found[i].second.latest, expected[i].second.latest, 1e-5);
  }
}

TEST(CarriedState, KnowsWhenRobotsWereHeardUntilTheNextBoot) {
  HandoverState carried;
  apply(carried, RecordKind::Clock, store::bytes_of(Clock{.boot = "b1", .at = {}, .stamp = 1.5e9}));
  apply(carried, RecordKind::Heard, store::bytes_of(Heard{.robot = "r1", .messages = 1, .last = 10}));
  Heard newest{.robot = "r1", .messages = 4, .gap = 1.5, .last = 20};
  newest.kinds[2] = {.accepted = 20, .forwarded = 19};
  newest.behind[2] = 18;
  apply(carried, RecordKind::Heard, store::bytes_of(newest));
  EXPECT_FALSE(carried.apply(RecordKind::Heard, store::bytes_of(newest).substr(1)));
  for (const HandoverState& each : {carried, again(carried)}) {
    ASSERT_THAT(each.heard_by_robot(), ElementsAre(Pair("r1", testing::_)));
    const Heard& heard = each.heard_by_robot().at("r1");
    EXPECT_EQ(std::tuple(heard.messages, heard.gap, heard.last), std::tuple(4u, 1.5, 20.0));
    EXPECT_TRUE(std::isnan(heard.kinds[0].accepted));
    EXPECT_EQ(heard.kinds[2].accepted, 20);
    EXPECT_EQ(heard.kinds[2].forwarded, 19);
    EXPECT_EQ(each.lag("r1", 2), 18);
    EXPECT_TRUE(std::isnan(each.lag("r1", 0)) && std::isnan(each.lag("r2", 2)));
  }
  carried.set_boot("b2");
  EXPECT_THAT(carried.heard_by_robot(), IsEmpty());
}

TEST(CarriedState, DropsTimesOfAnotherBoot) {
  using std::chrono::seconds;
  HandoverState carried;
  apply(carried, RecordKind::Clock,
        store::bytes_of(Clock{.boot = "b1", .at = pace::Instant(seconds(5)), .stamp = 1.5e9}));
  apply(carried, RecordKind::Pace,
        store::bytes_of(icd::Uri::MapUpdate, pace::LearnedRate{.spacing = seconds(7)}));
  carried.set_boot("b1");
  EXPECT_TRUE(carried.clock());
  EXPECT_THAT(carried.paces(), SizeIs(1));
  carried.set_boot("b2");
  EXPECT_FALSE(carried.clock());
  EXPECT_THAT(carried.paces(), IsEmpty()) << "the clock of an unknown boot";
}

TEST(CarriedState, SkipsUnknownRecords) {
  HandoverState carried;
  for (int kind = 0; kind < 256; ++kind) {
    for (const std::string said : {"", "?", "\x01\0\0\0\0\0\0\0"})
      (void)carried.apply(static_cast<RecordKind>(kind), said);
  }
  EXPECT_FALSE(carried.apply(static_cast<RecordKind>(99), ""));
  EXPECT_THAT(carried.robots(), IsEmpty());
  EXPECT_THAT(carried.markers().markers, IsEmpty());
}

TEST(CarriedState, KnowsPostedGridAreasOnceRecorded) {
  HandoverState carried;
  EXPECT_FALSE(carried.grids());
  apply(carried, RecordKind::Grids);
  EXPECT_THAT(again(carried).grids(), testing::Optional(IsEmpty()));
  const queues::Extent first{-1, -2, 3, 4}, larger{-1, -2, 30, 4};
  apply(carried, RecordKind::Grids, store::bytes_of("r1", first));
  apply(carried, RecordKind::Grids, store::bytes_of("r1", larger));
  apply(carried, RecordKind::Grids, store::bytes_of("*", queues::Extent::infinite()));
  EXPECT_FALSE(carried.apply(RecordKind::Grids, "torn"));
  carried.set_boot("another start");
  EXPECT_THAT(again(carried).grids(), testing::Optional(testing::ElementsAre(
                                          Pair("*", queues::Extent::infinite()), Pair("r1", larger))));
}

/// After any sequence of calls and with a snapshot at any place, a journal contains the queued messages.
TEST(CarriedState, KeepsQueuedMessages) {
  std::mt19937_64 random{1};
  const auto pick = [&](int below) { return std::uniform_int_distribution{0, below - 1}(random); };
  const auto any = [&](double x) {
    const int dice = pick(20);
    const auto action = dice == 0  ? icd::MarkerAction::DeleteAll
                        : dice < 5 ? icd::MarkerAction::Delete
                                   : icd::MarkerAction::Add;
    return action == icd::MarkerAction::DeleteAll ? marker("", 0, action, x)
                                                  : marker(pick(2) == 0 ? "a" : "b", pick(6), action, x);
  };
  HandoverState carried;
  std::vector<icd::Marker> waiting, under_way;
  for (int i = 0; i < 4000; ++i) {
    switch (pick(5)) {
      case 0: {  // accepted
        icd::MarkersUpdate update;
        for (int left = pick(4); left >= 0; --left) update.markers.push_back(any(i));
        apply(carried, RecordKind::Markers, store::bytes_of(update.markers));
        waiting = queues::merged(waiting, update.markers);
        break;
      }
      case 1:  // sent
        if (!under_way.empty() || waiting.empty()) break;
        under_way.assign(waiting.begin(), waiting.begin() + 1 + pick(static_cast<int>(waiting.size())));
        waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(under_way.size()));
        apply(carried, RecordKind::MarkersSent, names_of(under_way));
        break;
      case 2:
        under_way.clear();
        apply(carried, RecordKind::MarkersDone);
        break;
      case 3:
        waiting = queues::merged(under_way, waiting);
        under_way.clear();
        apply(carried, RecordKind::MarkersBack);
        break;
      default:
        carried = again(carried);
    }
    ASSERT_EQ(carried.markers().markers, queues::merged(under_way, waiting)) << i;
  }
}

}  // namespace
}  // namespace adit::journal
