#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <random>

#include "api/doubles.hpp"
#include "api/run_routes.hpp"
#include "api/scenes.hpp"
#include "codec/patched.hpp"
#include "loop/simulated_time.hpp"

namespace adit::api {
namespace {

using std::chrono::milliseconds;
using testing::Each;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

RunView team(int robots, int reports) {
  RunView view = *scene("calm", 1'793'000'000.5, 0);
  view.robots.clear();
  view.activities.clear();
  view.standings.clear();
  view.reports.clear();
  for (int i = 0; i < robots; ++i) {
    const std::string name = "ugv" + std::to_string(i);
    view.robots.push_back(
        {.name = name, .position = {.x = 1.5 * i, .y = 0, .z = 0}, .heading = 0.25, .at = view.now});
    for (const char* kind : {"grid", "cloud", "state"}) {
      facts::ActivityRow& row = view.activities.emplace_back();
      row.kind = kind;
      row.robot = name;
      row.last_accepted = view.now;
    }
  }
  for (int i = reports; i > 0; --i) {
    facts::ReportRow& row = view.reports.emplace_back();
    row.number = i;
    row.type = "Rope";
    row.position->x = 10.25 * i;
    row.state = "answered";
    row.received = row.changed = view.now;
  }
  return view;
}

/// Makes random changes to a view. All numbers are multiples of a thousandth, so that they survive JSON.
void change_some(RunView& view, std::mt19937_64& random) {
  view.now += 0.25;
  const auto any = [&random](auto& rows) -> auto& { return rows[random() % rows.size()]; };
  facts::RobotRow& robot = any(view.robots);
  robot.position.x += 0.125;
  facts::ActivityRow& activity = any(view.activities);
  ++activity.accepted;
  activity.behind_since = random() % 2 == 0 ? std::optional(view.now) : std::nullopt;
  any(view.reports).state = "settled";
  if (random() % 3 == 0) {
    facts::ReportRow report = view.reports.front();
    ++report.number;
    view.reports.insert(view.reports.begin(), report);
    view.reports.pop_back();
  }
  if (random() % 5 == 0) std::swap(view.activities.front(), view.activities.back());
  if (random() % 5 == 0) view.refusals.insert(view.refusals.begin(), facts::RefusalRow{})->at = view.now;
  if (random() % 7 == 0) view.refusals.clear();
  if (random() % 4 == 0) view.alarms.emplace_back().id = "robot_silent:ugv" + std::to_string(random() % 4);
  if (random() % 6 == 0) view.alarms.clear();
  if (random() % 6 == 0) view.run.reset();
  if (random() % 6 == 0) view.run.emplace().score = static_cast<int>(random() % 9);
}

class LiveTest : public testing::Test {
 protected:
  /// Opens another page; null if it was rejected.
  std::shared_ptr<FakeStream> open() {
    FakeResponder responder;
    live.open(responder, [this] { return welcome; });
    refusal = responder.answered;
    return responder.streaming;
  }

  void pass(milliseconds length) { time.pass(loop, length); }

  /// Makes a change that pages get at once.
  void change() {
    source.now.alarms.emplace_back();
    live.on_changed();
  }
  void change_in_the_queue() {
    ++source.now.queued_bytes;
    live.on_changed();
  }

  bool welcome = true;
  loop::SimulatedTime time;
  loop::Loop loop;
  FakeSource source;
  RunStream live{loop, source};
  std::optional<intake::Answer> refusal;
};

TEST_F(LiveTest, SendsTheRunAsJsonAtOnce) {
  source.now.version = "1.2.3";
  const auto page = open();
  ASSERT_THAT(page->sent, SizeIs(1));
  const std::string& event = page->sent[0];
  ASSERT_THAT(event, StartsWith("retry: 1000\ndata: {"));
  EXPECT_TRUE(event.ends_with("}\n\n"));
  EXPECT_EQ(event.find('\n', event.find("data: ")), event.size() - 2) << "the data has several lines";
  EXPECT_EQ(nlohmann::json::parse(event.substr(event.find('{')))["version"], "1.2.3");
}

TEST_F(LiveTest, LimitsEventsPerSecond) {
  const auto page = open();
  for (int i = 0; i < 100; ++i) {
    change();
    pass(milliseconds{10});
  }
  EXPECT_GE(page->sent.size(), 3);
  EXPECT_LE(page->sent.size(), 1 + RunStream::kEventsPerSecond + 1);
}

TEST_F(LiveTest, SendsMinorChangesOnceASecond) {
  const auto page = open();
  for (int i = 0; i < 300; ++i) {
    change_in_the_queue();
    pass(milliseconds{10});
  }
  EXPECT_GE(page->sent.size(), 1 + 2);
  EXPECT_LE(page->sent.size(), 1 + 3);
  pass(milliseconds{1000});
  EXPECT_THAT(page->sent.back(), HasSubstr("\"queued_bytes\":300"));
}

TEST_F(LiveTest, SendsReportsAndAlarmsWithoutDelay) {
  source.now = team(1, 1);
  const auto page = open();
  pass(milliseconds{300});
  source.now.alarms.emplace_back();
  live.on_changed();
  pass(milliseconds{40});
  EXPECT_THAT(page->sent, SizeIs(2));
  pass(milliseconds{250});
  change_in_the_queue();
  source.now.reports.front().state = "in_doubt";
  live.on_changed();
  pass(milliseconds{40});
  ASSERT_THAT(page->sent, SizeIs(3));
  EXPECT_THAT(page->sent[2], HasSubstr("queued_bytes")) << "a change is missing in the event";
}

TEST_F(LiveTest, SendsTheLastOfManyChanges) {
  const auto page = open();
  source.now.version = "old";
  live.on_changed();
  source.now.version = "new";
  live.on_changed();
  pass(milliseconds{1040});
  ASSERT_THAT(page->sent, SizeIs(2));
  EXPECT_NE(page->sent[1].find("\"new\""), std::string::npos);
}

TEST_F(LiveTest, SendsAHeartbeatWithinFiveSeconds) {
  static_assert(RunStream::kHeartbeat < milliseconds{5000});
  const auto page = open();
  pass(RunStream::kHeartbeat + milliseconds{100});
  EXPECT_THAT(page->sent, SizeIs(testing::Ge(2)));
}

TEST_F(LiveTest, ReadsNothingWithoutAnOpenPage) {
  live.on_changed();
  pass(milliseconds{300});
  EXPECT_EQ(source.asked, 0);
  open()->gone = true;
  change();
  pass(milliseconds{300});
  const int asked = source.asked;
  live.on_changed();
  pass(milliseconds{300});
  EXPECT_EQ(source.asked, asked) << "a closed page still causes requests";
}

TEST_F(LiveTest, ReadsTheViewOnceForAllPages) {
  const std::vector pages = {open(), open(), open()};
  const int asked = source.asked;
  change();
  pass(milliseconds{400});
  EXPECT_EQ(source.asked, asked + 1);
  for (const auto& page : pages) EXPECT_THAT(page->sent, SizeIs(2));
}

TEST_F(LiveTest, EndsWithTheSession) {
  const auto page = open();
  welcome = false;
  pass(RunStream::kHeartbeat + milliseconds{100});
  EXPECT_THAT(page->sent, SizeIs(1));
  EXPECT_EQ(page.use_count(), 1) << "the stream is still referenced";
}

TEST_F(LiveTest, SendsRunningTimesOnlyWithTheHeartbeat) {
  const auto page = open();
  for (int i = 0; i < 2; ++i) {
    source.now.now += 0.25;
    source.now.run_clock = {.seconds = source.now.now};
    live.on_changed();
    pass(milliseconds{260});
  }
  EXPECT_THAT(page->sent, SizeIs(1));
  pass(RunStream::kHeartbeat);
  ASSERT_THAT(page->sent, SizeIs(testing::Ge(2)));
  EXPECT_THAT(page->sent[1], StartsWith("event: patch\ndata: {\"now\":"));
}

TEST_F(LiveTest, SendsOnePoseInFewBytes) {
  source.now = team(20, 1000);
  const auto page = open();
  EXPECT_GT(page->sent[0].size(), 250'000);
  facts::RobotRow& robot = source.now.robots[7];
  robot.position = {.x = 81.123456789, .y = -1203.987654321, .z = 0.125};
  robot.heading = 3.0123456;
  robot.at = source.now.now = 1'793'000'124.123456;
  live.on_changed();
  pass(milliseconds{1040});
  ASSERT_THAT(page->sent, SizeIs(2));
  EXPECT_EQ(
      page->sent[1],
      "event: patch\ndata: {\"now\":1793000124.123,\"robots\":{\"rows\":{\"7\":{\"position\":{\"x\":81.123,"
      "\"y\":-1203.988,\"z\":0.125},\"heading\":3.012,\"at\":1793000124.123}}}}\n\n");
  EXPECT_LT(page->sent[1].size(), 180);
}

TEST_F(LiveTest, SendsAgesInWholeSeconds) {
  source.now = team(20, 0);
  std::optional<double>& standing = source.now.standings.emplace_back().age;
  source.now.activities[0].age = source.now.activities[1].heard = source.now.robots[2].age = standing = 7.2;
  const auto page = open();
  for (const double age : {7.9, 8.1}) {
    source.now.activities[0].age = source.now.activities[1].heard = source.now.robots[2].age = standing = age;
    change();
    pass(milliseconds{300});
  }
  ASSERT_THAT(page->sent, SizeIs(3));
  EXPECT_THAT(page->sent[1], testing::Not(HasSubstr("age")));
  EXPECT_THAT(page->sent[2], HasSubstr(R"("rows":{"2":{"age":8.0}})"));
  EXPECT_THAT(
      page->sent[2],
      HasSubstr(R"("rows":{"0":{"age":8.0},"1":{"heard":8.0}}},"standings":{"rows":{"0":{"age":8.0}})"));
}

TEST_F(LiveTest, SendsOneReportInFewBytes) {
  source.now = team(20, 1000);
  const auto page = open();
  facts::ReportRow report = source.now.reports.front();
  report.number = 1001;
  report.state = "queued";
  source.now.reports.insert(source.now.reports.begin(), report);
  source.now.reports.pop_back();
  live.on_changed();
  pass(milliseconds{300});
  source.now.reports.front().state = "sending";
  live.on_changed();
  pass(milliseconds{300});
  ASSERT_THAT(page->sent, SizeIs(3));
  EXPECT_LT(page->sent[1].size(), 450);
  EXPECT_THAT(page->sent[1], HasSubstr(R"("reports":{"kept":[[1,0,999]],"rows":{"0":{"number":1001,)"));
  EXPECT_EQ(page->sent[2],
            "event: patch\ndata: {\"reports\":{\"rows\":{\"0\":{\"state\":\"sending\"}}}}\n\n");
}

/// Times are converted from one clock to another, so their last digits change each time.
TEST_F(LiveTest, SendsNoTimesThatDifferBelowTheirPrecision) {
  source.now = team(4, 20);
  source.now.reports[3].position->x = 0.123456789;
  const auto page = open();
  EXPECT_THAT(page->sent[0], HasSubstr("0.123456789")) << "a report's identity must be exact";
  for (facts::ReportRow& report : source.now.reports) report.changed += 2e-7;
  for (facts::RobotRow& robot : source.now.robots) *robot.at += 2e-7;
  live.on_changed();
  pass(milliseconds{300});
  EXPECT_THAT(page->sent, SizeIs(1));
}

TEST_F(LiveTest, SendsASlowPageAWholeViewInsteadOfPatches) {
  source.now = team(6, 200);
  const auto slow = open(), fast = open();
  const std::size_t whole = slow->sent[0].size();
  slow->queued = whole + 30'000;  // a view that fits, and patches after it
  change();
  pass(milliseconds{300});
  EXPECT_THAT(slow->sent, SizeIs(2));
  EXPECT_THAT(slow->sent[1], StartsWith("event: patch\n"));
  slow->queued = 2 * whole + RunStream::kMostPatches;
  change();
  pass(milliseconds{300});
  ASSERT_THAT(slow->sent, SizeIs(3));
  EXPECT_EQ(slow->queued, 0) << "queued bytes remain";
  EXPECT_THAT(slow->sent[2], StartsWith("data: {\"now\":"));
  EXPECT_GT(slow->sent[2].size() + 100, whole);
  EXPECT_THAT(fast->sent[2], StartsWith("event: patch\n"));
}

/// Pages that open at any time, and slow pages, get the current view.
TEST_F(LiveTest, SendsEachViewToEachPage) {
  struct PageReader {
    std::shared_ptr<FakeStream> stream;
    std::size_t read = 0;
    codec::Value view = {};
  };
  std::mt19937_64 random(7);
  std::vector<PageReader> readers;
  source.now = team(4, 30);
  for (int step = 0; step < 30; ++step) {
    if (step % 8 == 0) readers.push_back({.stream = open()});
    if (step % 5 == 3) readers.back().stream->queued = 1u << 20;
    change_some(source.now, random);
    live.on_changed();
    pass(milliseconds{1040});
    for (PageReader& reader : readers) {
      for (; reader.read < reader.stream->sent.size(); ++reader.read) {
        const std::string& event = reader.stream->sent[reader.read];
        const std::size_t data = event.find("data: ");
        const codec::Value data_value =
            codec::parse_json(event.substr(data + 6, event.size() - data - 8)).value();
        reader.view =
            event.starts_with("event: patch") ? codec::test::patched(reader.view, data_value) : data_value;
      }
      const codec::Value now = codec::parse_json(codec::to_json(source.now)).value();
      ASSERT_EQ(codec::write_json(reader.view), codec::write_json(now)) << "step " << step;
    }
  }
}

TEST_F(LiveTest, ReservesConnectionsForRobots) {
  std::vector<std::shared_ptr<FakeStream>> pages;
  pages.reserve(RunStream::kMostPages);
  for (std::size_t i = 0; i < RunStream::kMostPages; ++i) pages.push_back(open());
  EXPECT_THAT(pages, Each(testing::NotNull()));
  EXPECT_EQ(open(), nullptr);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->status, icd::Status::ServiceUnavailable);
  EXPECT_TRUE(nlohmann::json::parse(refusal->body).is_string());
  pages[3]->gone = true;
  EXPECT_NE(open(), nullptr) << "a closed page must make room";
}

}  // namespace
}  // namespace adit::api
