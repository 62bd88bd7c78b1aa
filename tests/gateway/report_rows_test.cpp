#include "gateway/report_rows.hpp"

#include <gmock/gmock.h>

namespace adit::gateway {
namespace {

using dispatch::ReportState;
using testing::ElementsAre;

class NoOutput final : public dispatch::Output {
 public:
  bool write(std::span<const dispatch::Report>, const dispatch::Run*, dispatch::Flush) override {
    return false;
  }
  void answer_client(dispatch::ClientId, const dispatch::ClientAnswer&, const dispatch::Report&) override {}
};

std::vector<std::int64_t> latest(const std::vector<ReportState>& states, std::size_t most) {
  NoOutput output;
  dispatch::ReportBook book(output);
  std::vector<dispatch::Report> all;
  for (const ReportState state : states) {
    all.push_back({.number = static_cast<std::int64_t>(all.size()) + 1, .state = state});
  }
  book.open(std::move(all));
  std::vector<std::int64_t> numbers;
  for (const dispatch::Report* const report : latest_of(book, most)) numbers.push_back(report->number);
  return numbers;
}

TEST(LatestReports, AreTheNewestFirst) {
  const std::vector all{ReportState::Answered, ReportState::Rejected, ReportState::Withdrawn};
  EXPECT_THAT(latest(all, 5), ElementsAre(3, 2, 1));
  EXPECT_THAT(latest(all, 2), ElementsAre(3, 2));
  EXPECT_THAT(latest({}, 2), ElementsAre());
}

TEST(LatestReports, IncludeAllUnfinishedReports) {
  const std::vector all{ReportState::InDoubt, ReportState::Answered, ReportState::Held, ReportState::Answered,
                        ReportState::Answered};
  EXPECT_THAT(latest(all, 3), ElementsAre(5, 3, 1));
  EXPECT_THAT(latest(all, 2), ElementsAre(3, 1));
  EXPECT_THAT(latest(all, 1), ElementsAre(3, 1)) << "their alarms need all of them";
}

TEST(ReadAnswers, AreReadAgainAfterAChange) {
  ReadAnswers answers;
  dispatch::Report report{.number = 7};
  EXPECT_FALSE(answers.answer_of(report));
  const std::string reply = R"({"id": 1, "run": "2", "team": "t", "run_clock": 3.5, "type": "Drill", "x": 1,)"
                            R"( "y": 2, "z": 3, "report_status": "scored", "score_change": )";
  report.answer = reply + "1}";
  ASSERT_TRUE(answers.answer_of(report));
  EXPECT_EQ(answers.answer_of(report)->score_change, 1);
  report.answer = reply + "0}";
  ASSERT_TRUE(answers.answer_of(report));
  EXPECT_EQ(answers.answer_of(report)->score_change, 0);
  EXPECT_EQ(answers.answer_of(report)->report_status, "scored");
  report.answer = "not an answer";
  EXPECT_FALSE(answers.answer_of(report));
}

/// A proxy may repeat the answer to another report.
TEST(ReportRow, ShowsNoScoreOfAnotherReport) {
  NoOutput output;
  const dispatch::Reports reports({}, output);
  const auto score = [&](ReportState state, const char* type, double x) {
    ReadAnswers answers;
    const std::string answer = R"({"id": 1, "run": "2", "team": "t", "run_clock": 3.5, "type": ")" +
                               std::string(type) + R"(", "x": )" + std::to_string(x) +
                               R"(, "y": 2, "z": 3, "report_status": "scored", "score_change": 1})";
    const facts::ReportRow row = row_of(
        reports,
        {.number = 1, .report = {.type = "Drill", .position = {10, 2, 3}}, .state = state, .answer = answer},
        answers);
    EXPECT_EQ(row.report_status, row.score_change ? "scored" : "");
    return row.score_change;
  };
  EXPECT_EQ(score(ReportState::Answered, "Drill", 10), 1);
  EXPECT_EQ(score(ReportState::Answered, "Rope", 10), std::nullopt);
  EXPECT_EQ(score(ReportState::Answered, "Drill", 20), std::nullopt);
  EXPECT_EQ(score(ReportState::InDoubt, "Drill", 20), std::nullopt);
  EXPECT_EQ(score(ReportState::InDoubt, "Drill", 10), std::nullopt);
}

TEST(ReadAnswers, AreKeptPerReport) {
  ReadAnswers answers;
  const auto report = [](std::int64_t number) {
    return dispatch::Report{
        .number = number,
        .answer = R"({"id": 1, "run": "2", "team": "t", "run_clock": 3.5, "type": "Drill",)"
                  R"( "x": 1, "y": 2, "z": 3, "report_status": "scored", "score_change": )" +
                  std::to_string(number) + "}"};
  };
  for (int round = 0; round < 2; ++round) {
    for (std::int64_t number = 1; number <= 2500; ++number) {
      ASSERT_TRUE(answers.answer_of(report(number)));
      ASSERT_EQ(answers.answer_of(report(number))->score_change, number);
    }
  }
}

}  // namespace
}  // namespace adit::gateway
