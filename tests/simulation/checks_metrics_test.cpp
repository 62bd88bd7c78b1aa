#include "simulation/checks_metrics.hpp"

#include <gmock/gmock.h>

namespace adit::simulation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class ChecksMetricsTest : public testing::Test {
 protected:
  /// What is broken of a view with an alarm of report 1, and of metrics that have this one.
  Broken broken(const char* severity, const std::string& in_metrics) {
    reading_.view = {{"alarms", {{{"id", "report_in_doubt:1"}, {"severity", severity}}}},
                     {"activities", nlohmann::json::array()},
                     {"endpoints", nlohmann::json::array()},
                     {"run", nullptr}};
    reading_.metrics = "# metrics\nadit_alarm{id=\"" + in_metrics + "\",side=\"command_post\"} 1\n";
    return judged();
  }

  /// What is broken of a view with a stream of which one update was replaced, and of metrics that say two.
  Broken broken_of_a_stream(bool worked) {
    constexpr const char* kCounts[] = {"accepted", "forwarded", "replaced", "merged", "throttled", "failed"};
    nlohmann::json row = {{"kind", "cloud"}, {"robot", "R2"}};
    reading_.metrics = "# metrics\n";
    for (const std::string count : kCounts) {
      row[count] = 1;
      reading_.metrics += "adit_updates_" + count + "_total{kind=\"cloud\",robot=\"R2\"} " +
                          (count == "replaced" ? "2\n" : "1\n");
    }
    reading_.view = {{"alarms", nlohmann::json::array()},
                     {"activities", {row}},
                     {"endpoints", nlohmann::json::array()},
                     {"run", nullptr}};
    reading_.worked = worked;
    return judged();
  }

 private:
  Broken judged() const {
    Broken broken;
    judge_metrics(evidence_, reading_, broken);
    return broken;
  }

  const std::vector<Event> events_;
  const std::vector<dispatch::Report> reports_;
  const std::vector<Reading> readings_;
  const Evidence evidence_{.events = events_, .reports = reports_, .readings = readings_};
  Reading reading_;
};

TEST_F(ChecksMetricsTest, HaveTheAlarmsOfTheView) {
  EXPECT_THAT(broken("wait", "report_in_doubt:1"), IsEmpty());
  EXPECT_THAT(broken("wait", "report_in_doubt:2"), ElementsAre(HasSubstr("lack the alarm")));
}

TEST_F(ChecksMetricsTest, MayHaveALargerCauseOfADoubtThatTheViewIsTooOldFor) {
  EXPECT_THAT(broken("wait", "command_post_unreachable"), IsEmpty());
}

TEST_F(ChecksMetricsTest, CountAsTheViewDoes) {
  EXPECT_THAT(broken_of_a_stream(false), ElementsAre(HasSubstr("is 2, and by the view 1")));
}

TEST_F(ChecksMetricsTest, MayCountWhatAWorkerHasDoneSinceTheView) {
  EXPECT_THAT(broken_of_a_stream(true), IsEmpty());
}

TEST_F(ChecksMetricsTest, HideNothingThatTheOperatorDecides) {
  EXPECT_THAT(broken("ask", "command_post_unreachable"), ElementsAre(HasSubstr("lack the alarm")));
}

}  // namespace
}  // namespace adit::simulation
