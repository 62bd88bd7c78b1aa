#include "api/metrics.hpp"

#include <gmock/gmock.h>

#include "api/exposition_grammar.hpp"
#include "api/played.hpp"
#include "api/scenes.hpp"
#include "icd/sentence.hpp"

namespace adit::api {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

MetricsInput measured(const std::string& name) {
  const Time now = 1'780'000'000;
  MetricsInput measured{.view = *scene(name, now, 60), .reports = {}, .usage = {}, .about = {}};
  measured.reports = counts_of(measured.view.reports);
  return measured;
}

TEST(Metrics, FollowTheFormatForAnyRun) {
  for (const char* name : {"empty", "calm", "trouble", "reports", "hostile"}) {
    EXPECT_THAT(faults_of(write_metrics(measured(name))), IsEmpty()) << name;
  }
}

TEST(Metrics, ShowTheValuesOfTheView) {
  MetricsInput all = measured("calm");
  all.view.run =
      icd::RunStatus{.score = 7, .run_clock = 750, .remaining_reports = 18, .current_team = "adit"};
  all.view.run_clock = {.seconds = 756.5, .age = 2, .runs = true};
  all.view.endpoints = {{.name = "scoring",
                         .address = "",
                         .connected = true,
                         .trouble = "",
                         .answer_ms = 12.5,
                         .throttled = 3}};
  facts::ActivityRow clouds;
  clouds.kind = "cloud";
  clouds.robot = "ugv1";
  clouds.accepted = 9;
  clouds.forwarded = 4;
  clouds.replaced = 1;
  clouds.merged = 2;
  clouds.age = 33;
  clouds.heard = 8;
  clouds.no_room = 1110;
  clouds.clouds = "whole";
  clouds.precision = "8mm";
  clouds.no_valid_point = 3;
  all.view.activities = {clouds};
  all.view.sent_mbit = 8;
  all.view.budget_mbit = 20;
  all.view.alarms = {
      {.id = "robot_silent:ugv1", .side = alarms::Side::Robot},
      {.id = "reports_left", .severity = alarms::Severity::Wait, .side = alarms::Side::CommandPost}};
  all.usage.refused = {{.uri = "/map/update", .status = 422, .count = 5},
                       {.uri = "/state/update", .status = 422, .count = 2, .parts = 15}};
  all.usage.resident_bytes = 12'000'000;
  all.operators = 2;
  const std::string text = write_metrics(all);
  for (const char* sample : {"adit_run_score 7",
                             "adit_run_clock_seconds 756.5",
                             "adit_run_remaining_reports 18",
                             "adit_run_heard_age_seconds 2",
                             R"(adit_endpoint_up{endpoint="scoring"} 1)",
                             R"(adit_endpoint_answer_seconds{endpoint="scoring"} 0.0125)",
                             R"(adit_endpoint_throttled_total{endpoint="scoring"} 3)",
                             R"(adit_updates_accepted_total{kind="cloud",robot="ugv1"} 9)",
                             R"(adit_updates_forwarded_total{kind="cloud",robot="ugv1"} 4)",
                             R"(adit_updates_replaced_total{kind="cloud",robot="ugv1"} 1)",
                             R"(adit_updates_merged_total{kind="cloud",robot="ugv1"} 2)",
                             R"(adit_updates_heard_seconds{kind="cloud",robot="ugv1"} 8)",
                             R"(adit_updates_age_seconds{kind="cloud",robot="ugv1"} 33)",
                             R"(adit_updates_no_room_total{kind="cloud",robot="ugv1"} 1110)",
                             R"(adit_clouds_whole{robot="ugv1"} 1)",
                             R"(adit_clouds_rounded_metres{robot="ugv1"} 0.008)",
                             R"(adit_clouds_no_valid_point_total{robot="ugv1"} 3)",
                             "adit_link_rate_bytes_per_second 1e+06",
                             "adit_link_budget_bytes_per_second 2500000",
                             R"(adit_alarm{id="robot_silent:ugv1",severity="bad",side="robot"} 1)",
                             R"(adit_alarm{id="reports_left",severity="wait",side="command_post"} 1)",
                             R"(adit_alarms{severity="bad"} 1)",
                             R"(adit_alarms{severity="ask"} 0)",
                             R"(adit_refused_total{uri="/map/update",status="422"} 5)",
                             R"(adit_refused_parts_total{uri="/state/update"} 15)",
                             "adit_process_resident_memory_bytes 1.2e+07",
                             R"(adit_sessions{role="operator"} 2)"}) {
    EXPECT_THAT(text, HasSubstr(icd::sentence("\n", sample, "\n")));
  }
}

TEST(Metrics, CountReportsByState) {
  MetricsInput all = measured("empty");
  all.reports.in[static_cast<std::size_t>(dispatch::ReportState::Queued)] = 2;
  all.reports.asking = 1;
  const std::string text = write_metrics(all);
  EXPECT_THAT(text, HasSubstr("adit_reports{state=\"queued\"} 2\n"));
  EXPECT_THAT(text, HasSubstr("adit_reports{state=\"settled\"} 0\n"))
      << "the counter must exist before the first event";
  EXPECT_THAT(text, HasSubstr("adit_reports_asking 1\n"));
}

TEST(Exposition, EscapesTextThatCouldForgeASample) {
  Exposition out;
  out.begin("adit_x", "One line\nof \\ help.");
  out.sample({{"robot", "a\"} 1\nadit_y 2\\"}}, 0.5);
  EXPECT_EQ(out.text(),
            "# HELP adit_x One line\\nof \\\\ help.\n# TYPE adit_x gauge\n"
            "adit_x{robot=\"a\\\"} 1\\nadit_y 2\\\\\"} 0.5\n");
  EXPECT_THAT(faults_of(out.text()), IsEmpty());
}

TEST(ExpositionGrammar, FindsFaults) {
  const std::string head = "# HELP a_x X.\n# TYPE a_x gauge\n";
  EXPECT_THAT(faults_of(head + "a_x 1\n"), IsEmpty());
  for (const char* wrong :
       {"a_x 1\na_x 2\n", "a_y 1\n", "a_x one\n", "a_x{b=\"c} 1\n", "a_x{b=\"c\",} 1\n", "a_x{b=\"\"\"} 1\n",
        "a_x  1\n", "a_x 1", "\n", "# HELP a_x X.\n", "# HELP a_y Y.\n# TYPE a_y counter\n"}) {
    EXPECT_THAT(faults_of(head + wrong), Not(IsEmpty())) << wrong;
  }
}

}  // namespace
}  // namespace adit::api
