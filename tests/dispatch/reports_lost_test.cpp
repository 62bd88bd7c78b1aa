// Reports that a damaged ledger has lost.
#include <gmock/gmock.h>

#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kNote = "report 2 is lost from the ledger: it may have been sent";

/// Report 1 is answered; report 2 of the same run is lost.
class LostReport : public testing::Test {
 protected:
  /// Numbers of lost reports because of which new reports are held.
  std::vector<std::int64_t> holding() const {
    std::vector<std::int64_t> numbers;
    for (const Report* const lost : scene_.reports().lost_reports()) numbers.push_back(lost->number);
    return numbers;
  }

  LostReport() {
    scene_.post(1);
    scene_.answer(recorded_answer());
    Report lost = scene_.report(1);
    lost = {.number = 2, .report = {"?", {}}, .sender = std::string(Report::kLost), .state = InDoubt};
    lost.run = 1;
    lost.note = kNote;
    scene_.output().ledger[2] = lost;
    scene_.restart();
    scene_.repeat_status(2, 19, 0);
  }
  Scene scene_;
};

TEST_F(LostReport, HoldsNewReportsOfItsRun) {
  EXPECT_THAT(holding(), ElementsAre(2));
  const ClientId client = scene_.post(2);
  EXPECT_EQ(scene_.state(3), Held);
  EXPECT_THAT(scene_.report(3).note, HasSubstr(kNote));
  scene_.wait(21);
  EXPECT_THAT(scene_.output().answers[client].at(0).sentence,
              HasSubstr("is held until the operator decides"));
  EXPECT_TRUE(scene_.reports().send(3, scene_.time()));
  scene_.repeat_status(1, 19, 0);
  EXPECT_EQ(scene_.send_next(), 3);
}

TEST_F(LostReport, HoldsNoRepeatOfAKnownReport) {
  scene_.post(1);
  EXPECT_EQ(scene_.count(), 2u) << "it joins report 1";
}

TEST_F(LostReport, HoldsReportsPostedBeforeTheRunIsKnown) {
  scene_.restart();
  scene_.post(2);
  scene_.receive_status(19, 0);
  EXPECT_EQ(scene_.send_next(), 0);
  EXPECT_EQ(scene_.state(3), Held);
}

TEST_F(LostReport, HoldsNoReportOnceItIsSettled) {
  EXPECT_THAT(scene_.undecided(), ElementsAre(HasSubstr(kNote)));
  ASSERT_TRUE(scene_.reports().settle(2, scene_.time()));
  EXPECT_THAT(scene_.undecided(), ElementsAre());
  EXPECT_THAT(holding(), ElementsAre());
  scene_.repeat_status(1, 19, 0);
  scene_.post(2);
  EXPECT_EQ(scene_.state(3), Sending);
}

TEST_F(LostReport, HoldsNoReportOfAnotherRun) {
  scene_.reports().declare_new_run(scene_.time());
  scene_.receive_status(20, 0);
  scene_.post(2);
  EXPECT_EQ(scene_.state(3), Sending);
  EXPECT_THAT(scene_.undecided(), ElementsAre(HasSubstr(kNote))) << "still open";
  EXPECT_THAT(holding(), ElementsAre());
}

/// The records that are left may be older than a change of the settings.
TEST_F(LostReport, HoldsNewReportsForAnotherCommandPost) {
  scene_.restart(kThere);
  scene_.repeat_status(2, 15, 0);
  EXPECT_THAT(holding(), ElementsAre(2));
  scene_.post(2);
  EXPECT_EQ(scene_.state(3), Held);
  EXPECT_THAT(scene_.report(3).note, HasSubstr(kNote));
  ASSERT_TRUE(scene_.reports().settle(2, scene_.time()));
  scene_.repeat_status(1, 15, 0);
  scene_.post(4);
  EXPECT_EQ(scene_.state(4), Sending);
}

/// Reports that were lost after the last word of their run may be of the next one.
TEST_F(LostReport, HoldsNewReportsOfARunThatTheFirstStatusShows) {
  scene_.output().ledger[2].sent = scene_.reports().run().heard;
  scene_.restart();
  scene_.receive_status(25, 0);
  ASSERT_EQ(scene_.reports().run().number, 2);
  scene_.post(2);
  EXPECT_EQ(scene_.state(3), Held);
}

TEST_F(LostReport, CannotBeSent) {
  for (const auto& said :
       {scene_.reports().send(2, scene_.time()), scene_.reports().resubmit(2, scene_.time())}) {
    ASSERT_FALSE(said);
    EXPECT_THAT(said.error(), HasSubstr("report 2 is in doubt"));
  }
  ASSERT_TRUE(scene_.reports().settle(2, scene_.time()));
  const auto again = scene_.reports().resubmit(2, scene_.time());
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error(), HasSubstr("lost from the ledger"));
}

TEST_F(LostReport, KeepsItsNoteAtEachStatus) {
  scene_.post(3);
  ASSERT_TRUE(scene_.reports().send(3, scene_.time()));
  scene_.repeat_status(1, 19, 0);
  ASSERT_EQ(scene_.send_next(), 3);
  scene_.lose_answer();
  scene_.repeat_status(20, 18, 0);
  EXPECT_EQ(scene_.report(2).note, kNote);
  EXPECT_EQ(scene_.state(3), InDoubt) << "the lost report may have used one";
}

}  // namespace
}  // namespace adit::dispatch
