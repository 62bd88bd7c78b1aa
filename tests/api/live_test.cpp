#include "api/live.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "api/doubles.hpp"

namespace adit::api {
namespace {

using std::chrono::milliseconds;
using testing::Each;
using testing::SizeIs;
using testing::StartsWith;

class LiveTest : public testing::Test {
 protected:
  /// Opens one more page; null where it was refused.
  std::shared_ptr<FakeStream> open() {
    FakeResponder responder;
    live.open(responder, [this] { return welcome; });
    refusal = responder.answered;
    return responder.streaming;
  }

  void pass(milliseconds time) {
    const auto until = loop.now() + time;
    while (loop.now() < until) loop.turn(std::min<loop::Duration>(until - loop.now(), milliseconds{20}));
    loop.turn(milliseconds{0});  // what is due by then
  }

  bool welcome = true;
  loop::Loop loop;
  FakeSource source;
  Live live{loop, source};
  std::optional<intake::Answer> refusal;
};

TEST_F(LiveTest, SendsOneEventAtOnceThatIsTheRunAsJson) {
  source.now.version = "1.2.3";
  const auto page = open();
  ASSERT_THAT(page->sent, SizeIs(1));
  const std::string& event = page->sent[0];
  ASSERT_THAT(event, StartsWith("retry: 1000\ndata: {"));
  EXPECT_TRUE(event.ends_with("}\n\n"));
  EXPECT_EQ(event.find('\n', event.find("data: ")), event.size() - 2) << "data is one line";
  EXPECT_EQ(nlohmann::json::parse(event.substr(event.find('{')))["version"], "1.2.3");
}

TEST_F(LiveTest, SendsNoMoreEventsASecondThanAllowedHoweverMuchChanges) {
  const auto page = open();
  const auto began = loop.now();
  for (int i = 0; i < 100; ++i) {
    live.changed();
    pass(milliseconds{10});
  }
  const std::chrono::duration<double> passed = loop.now() - began;
  EXPECT_GE(page->sent.size(), 3);
  EXPECT_LE(static_cast<double>(page->sent.size()), 1 + Live::kEventsPerSecond * passed.count() + 1);
}

TEST_F(LiveTest, TellsAChangeThatComesAfterAPauseWithoutDelay) {
  const auto page = open();
  pass(milliseconds{300});
  live.changed();
  pass(milliseconds{40});
  EXPECT_THAT(page->sent, SizeIs(2));
}

TEST_F(LiveTest, TellsTheLastOfManyChanges) {
  const auto page = open();
  source.now.version = "old";
  live.changed();
  source.now.version = "new";
  live.changed();
  pass(milliseconds{400});
  ASSERT_THAT(page->sent, SizeIs(2));
  EXPECT_NE(page->sent[1].find("\"new\""), std::string::npos);
}

TEST_F(LiveTest, SaysSomethingWithinFiveSecondsThoughNothingChanges) {
  static_assert(Live::kHeartbeat < milliseconds{5000});
  const auto page = open();
  pass(Live::kHeartbeat + milliseconds{100});
  EXPECT_THAT(page->sent, SizeIs(testing::Ge(2)));
}

TEST_F(LiveTest, AsksForNothingWhileNoPageIsOpen) {
  live.changed();
  pass(milliseconds{300});
  EXPECT_EQ(source.asked, 0);
  open()->gone = true;
  live.changed();
  pass(milliseconds{300});
  const int asked = source.asked;
  live.changed();
  pass(milliseconds{300});
  EXPECT_EQ(source.asked, asked) << "the page that has gone is forgotten";
}

TEST_F(LiveTest, AsksOnceForAllPages) {
  const std::vector pages = {open(), open(), open()};
  const int asked = source.asked;
  live.changed();
  pass(milliseconds{400});
  EXPECT_EQ(source.asked, asked + 1);
  for (const auto& page : pages) EXPECT_THAT(page->sent, SizeIs(2));
}

TEST_F(LiveTest, EndsForWhoMayNotStay) {
  const auto page = open();
  welcome = false;
  pass(Live::kHeartbeat + milliseconds{100});
  EXPECT_THAT(page->sent, SizeIs(1));
  EXPECT_EQ(page.use_count(), 1) << "the stream has been dropped, and so ended";
}

TEST_F(LiveTest, LeavesTheRobotsTheirConnections) {
  std::vector<std::shared_ptr<FakeStream>> pages;
  pages.reserve(Live::kMostPages);
  for (std::size_t i = 0; i < Live::kMostPages; ++i) pages.push_back(open());
  EXPECT_THAT(pages, Each(testing::NotNull()));
  EXPECT_EQ(open(), nullptr);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->status, icd::Status::ServiceUnavailable);
  EXPECT_TRUE(nlohmann::json::parse(refusal->body).is_string());
  pages[3]->gone = true;
  EXPECT_NE(open(), nullptr) << "one that has gone makes room";
}

}  // namespace
}  // namespace adit::api
