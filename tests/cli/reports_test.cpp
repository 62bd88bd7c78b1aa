#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api/reports_csv.hpp"
#include "cli/run_adit.hpp"
#include "cli/status_text.hpp"
#include "cli/view.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;

facts::ReportRow report(std::int64_t number, std::int64_t run, const std::string& state) {
  facts::ReportRow row = sample_view().reports[0];
  row.number = number;
  row.run = run;
  row.state = state;
  return row;
}

/// Two runs; the second one is the current one.
std::vector<facts::ReportRow> two_runs() {
  return {report(1, 1, "answered"), report(2, 1, "held"), report(3, 2, "settled"), report(4, 2, "queued")};
}

std::string csv_of(const std::vector<facts::ReportRow>& rows) {
  std::string csv = api::csv_header();
  for (const facts::ReportRow& row : rows) csv += api::csv_line(row);
  return csv;
}

Outcome asked(const std::vector<facts::ReportRow>& rows, std::vector<std::string_view> words) {
  api::RunView view = sample_view();
  view.run_number = 2;
  const api::ReportDetail detail{rows.back(), {{1000, "queued", "posted"}}, "{}"};
  const Server server({{"GET /adit/run", Server::ok(codec::to_json(view))},
                       {"GET /adit/reports", Server::ok(codec::to_json(rows))},
                       {"GET /adit/reports.csv", Server::ok(csv_of(rows))},
                       {"GET /adit/reports/4", Server::ok(codec::to_json(detail))},
                       {"GET /adit/reports/5", Server::reply("404 Not Found", "\"there is no report 5\"")}});
  return run_adit(server, std::move(words));
}

TEST(Reports, ListThePresentRunAndUnfinishedEarlierOnes) {
  const auto rows = two_runs();
  const Outcome outcome = asked(rows, {"reports"});
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out, reports_text({rows[3], rows[2], rows[1]}, {.of_other_runs = 1}, 1000, false));
}

TEST(Reports, ListAnotherRunOrAll) {
  const auto rows = two_runs();
  EXPECT_EQ(asked(rows, {"reports", "--run", "1"}).out,
            reports_text({rows[1], rows[0]}, {.of_other_runs = 2}, 1000, false));
  EXPECT_EQ(
      asked(rows, {"reports", "--run", "3"}).out,
      "No reports in this run so far.\n4 reports of other runs are not listed: adit reports --run all\n");
  EXPECT_EQ(asked(rows, {"reports", "--run", "all"}).out,
            reports_text({rows[3], rows[2], rows[1], rows[0]}, {}, 1000, false));
}

TEST(Reports, ListTheNewest) {
  const auto rows = two_runs();
  EXPECT_EQ(asked(rows, {"reports", "--last", "2"}).out,
            reports_text({rows[3], rows[2]}, {.older = 1, .of_other_runs = 1}, 1000, false));
  EXPECT_EQ(asked(rows, {"reports", "--run", "all", "--last", "9"}).out,
            asked(rows, {"reports", "--run", "all"}).out);
  EXPECT_EQ(asked(rows, {"reports", "--last", "1", "--json"}).out,
            codec::to_json(std::vector<facts::ReportRow>{rows[3]}) + "\n");
}

TEST(Reports, AreAListForScripts) {
  const auto rows = two_runs();
  EXPECT_EQ(asked(rows, {"reports", "--json"}).out,
            codec::to_json(std::vector<facts::ReportRow>{rows[3], rows[2], rows[1]}) + "\n");
}

TEST(Reports, NeedAttentionIfOneAwaitsTheOperator) {
  EXPECT_EQ(asked(two_runs(), {"reports", "--run", "2"}).exit, Exit::Attention)
      << "also a report of another run";
  EXPECT_EQ(asked({report(4, 2, "in_doubt")}, {"reports"}).exit, Exit::Attention);
  EXPECT_EQ(asked({report(4, 2, "in_doubt")}, {"reports", "show", "4"}).exit, Exit::Attention);
  facts::ReportRow asking = report(4, 2, "in_doubt");
  asking.asking = true;
  EXPECT_EQ(asked({asking}, {"reports"}).exit, Exit::Fine);
  EXPECT_EQ(asked({report(4, 2, "answered")}, {"reports"}).exit, Exit::Fine);
  facts::ReportRow undoable = report(4, 2, "held");
  EXPECT_EQ(asked({undoable}, {"reports"}).exit, Exit::Attention);
  undoable.sends_at = 1010;
  EXPECT_EQ(asked({undoable}, {"reports"}).exit, Exit::Fine);
}

TEST(Reports, ShowOneOrTellThatItIsUnknown) {
  const Outcome outcome = asked(two_runs(), {"reports", "show", "4"});
  EXPECT_EQ(outcome.exit, Exit::Fine);
  EXPECT_THAT(outcome.out, testing::AllOf(HasSubstr("report    4\n"), HasSubstr("queued  posted\n")));
  EXPECT_THAT(asked(two_runs(), {"reports", "show", "4", "--json"}).out,
              testing::StartsWith("{\"number\":4,"));
  const Outcome none = asked(two_runs(), {"reports", "show", "5"});
  EXPECT_EQ(none.exit, Exit::Attention);
  EXPECT_EQ(none.err, "adit: there is no report 5\n");
}

TEST(Reports, AreExportedUnchanged) {
  const auto rows = two_runs();
  EXPECT_EQ(asked(rows, {"reports", "export"}).out, csv_of(rows));
  EXPECT_EQ(asked(rows, {"reports", "export", "--csv"}).out, csv_of(rows));
  EXPECT_EQ(asked(rows, {"reports", "export", "--json"}).out, codec::to_json(rows) + "\n");
  EXPECT_EQ(asked(rows, {"reports", "export"}).exit, Exit::Fine);
}

TEST(Reports, OfAnotherVersionAreRejected) {
  const Server server({{"GET /adit/run", Server::ok(codec::to_json(sample_view()))},
                       {"GET /adit/reports", Server::ok("[{\"number\": 1}]")}});
  const Outcome outcome = run_adit(server, {"reports"});
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_THAT(outcome.err, HasSubstr("it is another version"));
}

}  // namespace
}  // namespace adit::cli
