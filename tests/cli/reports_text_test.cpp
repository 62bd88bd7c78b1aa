#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/status_text.hpp"
#include "cli/view.hpp"
#include "dispatch/report.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;

facts::ReportRow in_state(const std::string& state) {
  facts::ReportRow report = sample_view().reports[0];
  report.state = state;
  return report;
}

TEST(ReportsText, HasARowForEachReport) {
  facts::ReportRow doubtful = in_state("in_doubt");
  doubtful.number = 14;
  doubtful.run = 2;
  doubtful.type = "Cell Phone";
  doubtful.status = 0;
  doubtful.report_status = "";
  doubtful.score_change = {};
  doubtful.note = "no answer within 10 s";
  doubtful.received = 990;
  doubtful.robot = "spot1";
  EXPECT_EQ(
      reports_text({doubtful, in_state("answered")}, {}, 1000, false),
      "  no.  run  type            x   y    z  state     score  answer or reason       sender    robot  "
      "received\n"
      "   14    2  Cell Phone  12.12  -3  0.5  in doubt         no answer within 10 s  10.0.0.7  spot1  "
      "10 s ago\n"
      "    3    1  Survivor    12.12  -3  0.5  answered     +1  scored                 10.0.0.7         "
      "60 s ago\n");
}

TEST(ReportsText, HasNoPositionForALostReport) {
  facts::ReportRow lost = in_state("in_doubt");
  lost.position = {};
  lost.position.reset();
  EXPECT_THAT(reports_text({lost}, {}, 1000, false), HasSubstr("lost  lost  lost"));
  EXPECT_THAT(report_text({.row = lost, .history = {}, .answer = ""}, false), HasSubstr("lost"));
}

TEST(ReportsText, TellsThatThereAreNone) {
  EXPECT_EQ(reports_text({}, {}, 1000, false), "No reports so far.\n");
  EXPECT_EQ(
      reports_text({}, {.of_other_runs = 12}, 1000, false),
      "No reports in this run so far.\n12 reports of other runs are not listed: adit reports --run all\n");
  EXPECT_THAT(reports_text({in_state("answered")}, {.of_other_runs = 1}, 1000, false),
              testing::EndsWith("\n1 report of another run is not listed: adit reports --run all\n"));
  EXPECT_THAT(reports_text({in_state("answered")}, {.older = 2}, 1000, false),
              testing::EndsWith("\n2 older reports are not listed\n"));
}

TEST(ReportsText, EscapesTerminalSequences) {
  facts::ReportRow report = in_state("\x1b[2J");
  report.type = report.sender = report.note = "\x1b[2J\n";
  EXPECT_EQ(reports_text({report}, {}, 1000, false).find('\x1b'), std::string::npos);
  EXPECT_EQ(report_text({report, {{1000, "\x1b[2J", "\x1b[2J"}}, "\x1b[2J"}, false).find('\x1b'),
            std::string::npos);
}

TEST(StateText, NamesTheAwaitedDecision) {
  facts::ReportRow doubt = in_state("in_doubt");
  EXPECT_EQ(report_state(doubt), "in doubt");
  EXPECT_TRUE(needs_the_operator(doubt));
  doubt.asking = true;
  EXPECT_EQ(report_state(doubt), "in doubt, asking");
  EXPECT_FALSE(needs_the_operator(doubt));
  EXPECT_EQ(report_state(in_state("held")), "held");
  EXPECT_TRUE(needs_the_operator(in_state("held")));
  facts::ReportRow undoable = in_state("held");
  undoable.sends_at = 1010;
  EXPECT_EQ(report_state(undoable), "held, to be sent");
  EXPECT_FALSE(needs_the_operator(undoable));
}

TEST(StateText, IsTheWordOfTheState) {
  for (const std::string_view word : dispatch::kStateWords) {
    if (word != "in_doubt") EXPECT_EQ(report_state(in_state(std::string(word))), word);
  }
  EXPECT_EQ(report_state(in_state("a later one")), "a later one");
}

TEST(AnswerText, IsTheAnswerInWords) {
  facts::ReportRow report = in_state("answered");
  EXPECT_EQ(outcome_text(report), "scored");
  report.reconciled = true;
  EXPECT_EQ(outcome_text(report), "found out, scored");
  report = in_state("rejected");
  report.status = 422;
  report.report_status = "";
  EXPECT_EQ(outcome_text(report), "error 422");
}

TEST(StateText, IsExplainedInTheHelp) {
  for (const auto& row : dispatch::report_life()) {
    facts::ReportRow report = in_state(std::string(dispatch::name_of(row.from)));
    EXPECT_THAT(help_of("reports"), HasSubstr("\n  " + report_state(report) + " "));
    report.reconciled = report.asking = true;
    EXPECT_THAT(help_of("reports"), HasSubstr("\n  " + report_state(report) + " "));
  }
}

TEST(ReportText, ShowsAllOfOneReport) {
  facts::ReportRow report = in_state("settled");
  report.received = 1566309785.125;
  report.reconciled = true;
  report.note = "recorded: the count of reports fell by one";
  report.run = 2;
  report.robot = "spot1";
  const api::ReportDetail detail{report,
                                 {{1566309785.125, "queued", ""}, {1566309786, "in_doubt", "no answer"}},
                                 "{\"score_change\": 1}"};
  EXPECT_EQ(report_text(detail, false),
            "  report    3\n"
            "  type      Survivor\n"
            "  at        12.125, -3, 0.5 m\n"
            "  state     settled\n"
            "  reason    recorded: the count of reports fell by one\n"
            "  answer    found out, scored\n"
            "  score     +1\n"
            "  run       2\n"
            "  sender    10.0.0.7\n"
            "  robot     spot1\n"
            "  received  2019-08-20T14:03:05.125Z\n"
            "  actions   resubmit\n"
            "\n"
            "History\n"
            "  2019-08-20T14:03:05.125Z  queued\n"
            "  2019-08-20T14:03:06.000Z  in doubt  no answer\n");
}

TEST(ReportText, HasTheSentenceOfARejection) {
  const api::ReportDetail detail{in_state("rejected"), {}, "\"no such type\""};
  EXPECT_THAT(report_text(detail, false), HasSubstr("  message   no such type\n"));
}

TEST(ReportText, OffersThePossibleActions) {
  const auto actions = [](const std::string& state) {
    const std::string text = report_text({in_state(state), {}, ""}, false);
    const auto begin = text.find("actions   ");
    return begin == std::string::npos ? "" : text.substr(begin + 10, text.find('\n', begin) - begin - 10);
  };
  EXPECT_EQ(actions("held"), "send, withdraw, correct");
  EXPECT_EQ(actions("queued"), "send, hold, withdraw");
  EXPECT_EQ(actions("sending"), "");
  EXPECT_EQ(actions("in_doubt"), "send, settle");
  EXPECT_EQ(actions("answered"), "resubmit");
  EXPECT_EQ(actions("rejected"), "send, resubmit");
  EXPECT_EQ(actions("withdrawn"), "send, resubmit");
}

}  // namespace
}  // namespace adit::cli
