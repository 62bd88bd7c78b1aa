#include "cli/reports_text.hpp"

#include <gtest/gtest.h>

#include "cli/view.hpp"

namespace adit::cli {
namespace {

TEST(ReportsText, HasARowForEachReport) {
  page::RunView view = sample_view();
  page::ReportRow doubtful = view.reports[0];
  doubtful.number = 14;
  doubtful.type = "Cell Phone";
  doubtful.state = "in doubt";
  doubtful.status = 0;
  doubtful.report_status = "";
  doubtful.score_change = {};
  doubtful.note = "no answer within 10 s";
  doubtful.received = 990;
  view.reports.insert(view.reports.begin(), doubtful);
  EXPECT_EQ(
      reports_text(view, false),
      "  no.  type            x   y    z  state     score  the Command Post said  sender    received\n"
      "   14  Cell Phone  12.12  -3  0.5  in doubt         no answer within 10 s  10.0.0.7  10 s ago\n"
      "    3  Survivor    12.12  -3  0.5  answered     +1  201, scored            10.0.0.7  60 s ago\n");
  EXPECT_TRUE(any_in_doubt(view));
}

TEST(ReportsText, SaysThatThereAreNone) {
  EXPECT_EQ(reports_text({}, false), "No reports so far.\n");
  EXPECT_FALSE(any_in_doubt({}));
}

TEST(ReportsText, NeverLetsOthersSteerTheTerminal) {
  page::RunView view = sample_view();
  view.reports[0].type = view.reports[0].sender = view.reports[0].note = "\x1b[2J\n";
  EXPECT_EQ(reports_text(view, false).find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace adit::cli
