#include <gmock/gmock.h>

#include "dispatch/reports.hpp"
#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;

std::string meaning(const Scene& scene, const std::string& post = kThere) {
  return describe_command_post_change(scene.reports(), post);
}

TEST(ChangeOfCommandPost, AffectsNoFinalReport) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded_answer());
  EXPECT_EQ(meaning(scene),
            "reports go to 10.100.2.200:8000 from then on; no report is queued, in doubt or held now");
}

TEST(ChangeOfCommandPost, KeepsOpenReportsForTheOldOne) {
  Scene scene;
  scene.post_queued(1);
  scene.post_queued(2);
  ASSERT_TRUE(scene.reports().hold(1, scene.time()));
  EXPECT_EQ(meaning(scene),
            "reports go to 10.100.2.200:8000 from then on; 1 report is queued, 1 is held: Adit keeps them "
            "for the run at 10.100.1.200:8000, and sends them to the new Command Post only on request");
  scene.send_next();
  EXPECT_THAT(meaning(scene), HasSubstr("; 1 report is in doubt, 1 is held: "));
  scene.lose_answer();
  scene.post_queued(3);
  scene.post_queued(4);
  EXPECT_THAT(meaning(scene), HasSubstr("; 2 reports are queued, 1 is in doubt, 1 is held: "));
}

TEST(ChangeOfCommandPost, ContinuesTheRunOfAnEarlierOne) {
  Scene scene;
  scene.post(1);
  scene.answer(recorded_answer());
  scene.post_queued(2);
  scene.restart(kThere);
  scene.receive_status(20, 0);
  EXPECT_EQ(meaning(scene, kHere),
            "reports go to 10.100.1.200:8000 from then on; run 1 there continues, with 2 reports; no report "
            "is queued, in doubt or held now");
}

TEST(ChangeOfCommandPost, TakesQueuedReportsIfTheOldOneNeverAnswered) {
  Scene scene;
  scene.restart(kThere);
  scene.post_queued(1);
  EXPECT_THAT(meaning(scene, kHere),
              AllOf(HasSubstr("1 report is queued: the Command Post at 10.100.2.200:8000"),
                    EndsWith("queued reports are sent to the first Command Post that answers")));
}

}  // namespace
}  // namespace adit::dispatch
