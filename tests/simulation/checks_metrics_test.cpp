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
    Broken broken;
    judge_metrics(evidence_, reading_, broken);
    return broken;
  }

 private:
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

TEST_F(ChecksMetricsTest, HideNothingThatTheOperatorDecides) {
  EXPECT_THAT(broken("ask", "command_post_unreachable"), ElementsAre(HasSubstr("lack the alarm")));
}

}  // namespace
}  // namespace adit::simulation
