// The order of jobs, in simulated time.
#include <gtest/gtest.h>

#include <string>

#include "loop/workers.hpp"

namespace adit::loop {
namespace {

using std::chrono::milliseconds;
using Queue = JobQueue<std::string>;

constexpr Instant kBegin{std::chrono::seconds(100)};

Instant at(int ms) {
  return kBegin + milliseconds(ms);
}

class JobQueueTest : public testing::Test {
 protected:
  void urgent(const char* job, int ms = 0) { queue.add(job, Urgency::OnTheWay, at(ms)); }
  void patient(const char* job, int ms = 0) { queue.add(job, Urgency::CanWait, at(ms)); }
  /// Takes the next job; "" if there is none. The caller must report its end.
  std::string taken(int ms) {
    auto next = queue.pop(at(ms));
    if (!next) return "";
    last = next->urgency;
    return next->job;
  }
  void ended(int ms) { queue.on_ended(last, at(ms)); }
  /// Takes the next job and ends it at once.
  std::string done(int ms) {
    std::string job = taken(ms);
    if (!job.empty()) ended(ms);
    return job;
  }

  Queue queue{1};
  Urgency last = Urgency::OnTheWay;
};

TEST_F(JobQueueTest, UrgentJobsGoFirst) {
  patient("picture");
  urgent("cloud");
  urgent("grid");
  EXPECT_EQ(done(1), "cloud");
  EXPECT_EQ(done(2), "grid");
  EXPECT_EQ(done(3), "picture");
  EXPECT_EQ(done(4), "");
}

TEST_F(JobQueueTest, JobsOfOneUrgencyKeepTheirOrder) {
  for (const char* job : {"a", "b", "c"}) {
    urgent(job);
    patient(job);
  }
  for (const char* job : {"a", "b", "c", "a", "b", "c"}) EXPECT_EQ(done(1), job);
}

TEST_F(JobQueueTest, PatientJobHasATurnAfterALongWait) {
  patient("picture");
  patient("bundle");
  for (int i = 0; i < 20; ++i) urgent("cloud");
  EXPECT_EQ(done(99), "cloud");
  EXPECT_EQ(taken(100), "picture");
  ended(150);
  EXPECT_EQ(done(150), "cloud");
  EXPECT_EQ(done(249), "cloud");
  EXPECT_EQ(done(250), "bundle");
}

TEST_F(JobQueueTest, UrgentJobsHaveTheirShareBetweenPatientOnes) {
  for (int i = 0; i < 50; ++i) patient("bundle");
  int time = 0, work_of_others = 0;
  for (int i = 0; i < 50; ++i) {
    urgent("cloud", time);
    const std::string job = taken(time);
    const int took = job == "bundle" ? 300 : 20;
    time += took;
    if (job == "cloud") work_of_others += took;
    ended(time);
  }
  EXPECT_GE(work_of_others, 400) << "100 of each 400 ms";
  EXPECT_LT(work_of_others, time) << "some bundles are made";
}

TEST_F(JobQueueTest, PatientJobsBeginInTimeUnderLoad) {
  patient("1");
  patient("2");
  patient("3");
  std::string begun;
  for (int time = 0; time < 350; time += 10) {
    urgent("cloud", time);
    if (const std::string job = done(time); job != "cloud") begun += job + '@' + std::to_string(time) + ' ';
  }
  EXPECT_EQ(begun, "1@100 2@200 3@300 ");
}

TEST_F(JobQueueTest, OneWorkerIsFreeOfPatientJobs) {
  Queue three{3};
  for (int i = 0; i < 3; ++i) three.add("bundle", Urgency::CanWait, kBegin);
  EXPECT_TRUE(three.pop(at(1)));
  EXPECT_TRUE(three.pop(at(1)));
  EXPECT_FALSE(three.pop(at(500)));
  three.add("cloud", Urgency::OnTheWay, at(500));
  EXPECT_EQ(three.pop(at(501))->job, "cloud");
  three.on_ended(Urgency::CanWait, at(502));
  EXPECT_EQ(three.pop(at(503))->job, "bundle");
}

TEST_F(JobQueueTest, PatientJobYieldsAndContinues) {
  patient("picture");
  ASSERT_EQ(taken(0), "picture");
  EXPECT_FALSE(queue.pop_amid(at(0), at(50), at(50))) << "no other job was queued";
  urgent("cloud", 1);
  urgent("grid", 1);
  EXPECT_FALSE(queue.pop_amid(at(0), at(9), at(9))) << "the turn has just begun";
  EXPECT_EQ(queue.pop_amid(at(0), at(10), at(10)), "cloud");
  EXPECT_FALSE(queue.pop_amid(at(0), at(10), at(110))) << "the job has yielded long enough";
  EXPECT_EQ(queue.pop_amid(at(110), at(120), at(120)), "grid");
  EXPECT_FALSE(queue.pop_amid(at(110), at(120), at(125)));
}

TEST_F(JobQueueTest, PatientJobDoesNotYieldToPatientJobs) {
  patient("picture");
  ASSERT_EQ(taken(0), "picture");
  patient("bundle");
  EXPECT_FALSE(queue.pop_amid(at(0), at(500), at(500)));
}

TEST_F(JobQueueTest, HandsOverQueuedJobs) {
  patient("picture");
  urgent("cloud");
  Queue other{1};
  queue.hand_over_to(other);
  EXPECT_EQ(queue.size(), 0U);
  EXPECT_EQ(done(1), "");
  EXPECT_EQ(other.size(), 2U);
}

}  // namespace
}  // namespace adit::loop
