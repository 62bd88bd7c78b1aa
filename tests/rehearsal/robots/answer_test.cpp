#include <gtest/gtest.h>

#include "rehearsal/robots/client.hpp"

namespace adit::robots {
namespace {

TEST(SentenceOf, FindsTheSentenceOfTheServer) {
  const std::pair<const char*, const char*> cases[] = {
      {R"("Missing field: 'y'")", "Missing field: 'y'"},
      {R"({"detail": "Invalid token."})", "Invalid token."},
      {R"({"error": 1})", R"({"error": 1})"},
      {"null", "null"},
      {"", "(empty body)"},
      {"<html>\n<body>", "not JSON: <html>"},
      {"\x1b[2J\x07", "not JSON: ?[2J?"},
  };
  for (const auto& [body, sentence] : cases) EXPECT_EQ(sentence_of(body), sentence);
}

TEST(SentenceOf, IsShortForAnyAnswer) {
  EXPECT_LT(sentence_of(std::string(1 << 20, 'x')).size(), 200u);
}

TEST(ReportAnswer, IsReadFromTheExampleOfTheIcd) {
  const auto answer = parse_report_answer(
      R"({"url": "http://<ipaddress>:<port>/api/artifact_reports/1", "id": 1, "x": 1011.242, "y": -244.433,
      "z": -10.011, "type": "backpack", "submitted_datetime": "2019-01-01T00:00:00.000000-07:00",
      "run_clock": 721.4, "team": "subt", "run": 1, "report_status": "scored", "score_change": 1})");
  ASSERT_TRUE(answer) << answer.error();
  EXPECT_EQ(*answer, "scored +1");
}

TEST(ReportAnswer, NamesAMissingMember) {
  const auto answer = parse_report_answer(R"({"type": "rope", "x": 1, "y": 2, "z": "3"})");
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error(), "the answer's 'z' is not a number");
  EXPECT_EQ(parse_report_answer("<html>").error(), "the answer is not a JSON object");
}

TEST(StatusAnswer, ReadsTheRunClockByEitherName) {
  for (const char* clock : {"run_clock", "clock"}) {
    const auto status = check_status_answer(std::string(R"({"score": 6, "remaining_reports": 14, ")") +
                                            clock + R"(": 721.4, "current_team": "subt"})");
    EXPECT_TRUE(status) << status.error();
  }
  EXPECT_FALSE(check_status_answer(R"({"score": 6})"));
}

TEST(Tally, IsCleanUntilAMessageIsRejectedExceptBy429) {
  Tally tally;
  tally.count(MessageKind::Grid, Fate::Posted);
  tally.count(MessageKind::Grid, Fate::Accepted);
  tally.count(MessageKind::Cloud, Fate::Throttled);
  tally.count(MessageKind::State, Fate::Unanswered, "stopped");
  EXPECT_TRUE(tally.clean());
  tally.count(MessageKind::Markers, Fate::Rejected, "422 markers[0].ns: expected a string");
  EXPECT_FALSE(tally.clean());
  EXPECT_NE(tally.summary().find("markers: 422 markers[0].ns: expected a string (1 times)"),
            std::string::npos);
}

TEST(Tally, IsNotCleanAfterAFailure) {
  Tally tally;
  tally.count_failure("a.pcd: no points");
  EXPECT_FALSE(tally.clean());
}

TEST(Tally, IsBoundedForAnyAnswers) {
  Tally tally;
  for (int i = 0; i < 10'000; ++i) tally.count(MessageKind::Grid, Fate::Rejected, "500 " + std::to_string(i));
  EXPECT_LT(tally.summary().size(), 5000u);
  EXPECT_NE(tally.summary().find("(others) (9950 times)"), std::string::npos);
}

}  // namespace
}  // namespace adit::robots
