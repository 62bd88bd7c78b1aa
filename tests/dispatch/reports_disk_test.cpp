// A full disk: an action that is not stored has no effect, and an event that happened is written later.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::HasSubstr;

class FullDisk : public testing::Test {
 protected:
  void fill() { scene_.output().full = true; }
  void make_room() { scene_.output().full = false; }
  ReportState on_disk(std::int64_t number) { return scene_.output().ledger.at(number).state; }
  Scene scene_;
};

TEST_F(FullDisk, RejectsReports) {
  fill();
  const auto told = scene_.answer_to(scene_.post());
  EXPECT_EQ(told.status, 503);
  EXPECT_EQ(told.sentence, "the report could not be stored and was not accepted; post it again");
  EXPECT_EQ(told.number, 0);
  EXPECT_EQ(scene_.reports().sending(), nullptr);
  EXPECT_EQ(scene_.count(), 0);
  make_room();
  scene_.post();
  EXPECT_EQ(scene_.state(1), Sending);
}

TEST_F(FullDisk, SendsNoReport) {
  scene_.post_queued();
  fill();
  EXPECT_EQ(scene_.send_next(), 0);
  EXPECT_EQ(scene_.reports().sending(), nullptr);
  EXPECT_EQ(scene_.state(1), Queued);
  make_room();
  EXPECT_EQ(scene_.send_next(), 1);
}

TEST_F(FullDisk, PassesOnAnAnswerAndWritesItLater) {
  const ClientId client = scene_.post();
  fill();
  scene_.answer(recorded_answer(1));
  EXPECT_EQ(scene_.answer_to(client).body, recorded_answer(1).body);
  EXPECT_EQ(scene_.answer_to(scene_.post()).body, recorded_answer(1).body) << "a repeat";
  EXPECT_EQ(on_disk(1), Sending);
  make_room();
  scene_.wait(1);
  EXPECT_EQ(on_disk(1), Answered);
  EXPECT_EQ(scene_.output().ledger.at(1).answer, recorded_answer(1).body);
}

TEST_F(FullDisk, KeepsAnAnswerAndANewRunOverAChangeOfTheCommandPost) {
  scene_.repeat_status(10, 20, 3);
  scene_.post();
  fill();
  scene_.answer(recorded_answer(1));
  scene_.wait(1);
  scene_.receive_status(25, 0, 0.5);  // another run
  const std::int64_t run = scene_.reports().run().number;
  scene_.move_to("10.100.2.200:8000");
  EXPECT_EQ(scene_.state(1), Answered);
  scene_.move_to("10.100.1.200:8000");
  EXPECT_EQ(scene_.reports().run().number, run);
  make_room();
  scene_.wait(1);
  EXPECT_EQ(on_disk(1), Answered);
  scene_.restart();
  EXPECT_EQ(scene_.reports().run().number, run);
}

TEST_F(FullDisk, ResendsNoReportThatIsNotStoredAsQueued) {
  scene_.post();
  scene_.lose_answer();
  fill();
  scene_.repeat_status(20, 20, 0);
  EXPECT_EQ(scene_.state(1), InDoubt);
  EXPECT_EQ(scene_.send_next(), 0);
  make_room();
  scene_.repeat_status(1, 20, 0);
  EXPECT_EQ(scene_.send_next(), 1);
}

TEST_F(FullDisk, BeginsANewRunAndWritesItLater) {
  scene_.post_queued();
  scene_.wait(11);
  fill();
  scene_.receive_status(25, 0, 3);
  EXPECT_EQ(scene_.reports().run().number, 2);
  EXPECT_EQ(scene_.state(1), Held);
  make_room();
  scene_.wait(1);
  EXPECT_EQ(scene_.output().run->number, 2);
  EXPECT_EQ(on_disk(1), Held);
}

TEST_F(FullDisk, RejectsTheOperatorsActions) {
  scene_.post(1);
  scene_.lose_answer();
  scene_.post(2);
  fill();
  EXPECT_THAT(scene_.reports().settle(1, scene_.time()).error(), HasSubstr("could not be stored"));
  EXPECT_FALSE(scene_.reports().send(1, scene_.time()).has_value());
  EXPECT_FALSE(scene_.reports().withdraw(2, scene_.time()).has_value());
  EXPECT_FALSE(scene_.reports().hold(2, scene_.time()).has_value());
  EXPECT_EQ(scene_.state(1), InDoubt);
  EXPECT_EQ(scene_.state(2), Queued);
}

/// The disk is full after each number of writes. A restart then sends nothing that may be recorded.
TEST(FillingDisk, NeverSendsAReportTwice) {
  for (std::int64_t writes = 0; writes < 12; ++writes) {
    Scene scene;
    scene.output().writes_until_full = writes;
    const ClientId client = scene.post();
    const bool left = scene.reports().sending() != nullptr;
    EXPECT_EQ(left, writes >= 1);
    EXPECT_EQ(scene.answer_to(client).status, left ? 0 : 503);
    if (left) scene.lose_answer();
    scene.repeat_status(2, left ? 19 : 20, 0);
    scene.output().writes_until_full = -1;
    scene.restart();
    scene.repeat_status(20, left ? 19 : 20, 0);
    EXPECT_EQ(scene.send_next(), 0) << writes;
    if (left) {
      EXPECT_EQ(scene.state(1), Settled) << writes;
    }
  }
}

}  // namespace
}  // namespace adit::dispatch
