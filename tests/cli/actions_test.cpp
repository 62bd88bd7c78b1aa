#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/run_adit.hpp"
#include "cli/view.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Adit's row of a report in that state.
std::string report(const std::string& state, bool asking = false) {
  api::ReportDetail detail{.row = sample_view().reports.front(), .history = {}, .answer = ""};
  detail.row.state = state;
  detail.row.asking = asking;
  return Server::ok(codec::to_json(detail));
}

TEST(Actions, SendRequestsByTheirNames) {
  const Server server({{"GET /adit/reports/7", report("held")},
                       {"POST /adit/reports/7/send", Server::ok("{\"report\":7}")},
                       {"POST /adit/reports/7/hold", Server::ok("{\"report\":7}")},
                       {"POST /adit/reports/7/withdraw", Server::ok("{\"report\":7}")},
                       {"POST /adit/reports/7/settle", Server::ok("{\"report\":7}")},
                       {"POST /adit/reports/7/resubmit", Server::ok("{\"report\":12}")},
                       {"POST /adit/runs", Server::ok("{\"run\":2}")}});
  EXPECT_EQ(run_adit(server, {"reports", "send", "7"}).out, "report 7 is queued\n");
  EXPECT_EQ(run_adit(server, {"reports", "hold", "7"}).out, "report 7 is held until you send it\n");
  EXPECT_EQ(run_adit(server, {"reports", "withdraw", "7"}).out, "report 7 is withdrawn\n");
  EXPECT_EQ(run_adit(server, {"reports", "settle", "7"}).out, "report 7 is settled\n");
  EXPECT_EQ(run_adit(server, {"reports", "resubmit", "7"}).out, "report 7 is sent again as report 12\n");
  EXPECT_EQ(run_adit(server, {"reports", "resubmit", "7", "--json"}).out, "{\"report\":12}\n");
  EXPECT_EQ(run_adit(server, {"run", "new", "--yes"}).out,
            "run 2 begins; unsent reports of earlier runs are held: see adit reports\n");
  const Outcome outcome = run_adit(server, {"run", "new", "--yes", "--json"});
  EXPECT_EQ(outcome.out, "{\"run\":2}\n");
  EXPECT_EQ(outcome.exit, Exit::Fine);
}

TEST(Actions, CorrectTheNamedFieldsOfAReport) {
  const Server server({{"GET /adit/reports/7", report("held")},
                       {"POST /adit/reports/7/correct", Server::ok("{\"report\":8}")}});
  EXPECT_EQ(run_adit(server, {"reports", "correct", "7", "type=Rope", "y=-3.5"}).out,
            "report 7 is corrected as report 8\n");
  EXPECT_THAT(server.posted(), HasSubstr(R"("type":"Rope")"));
  EXPECT_THAT(server.posted(), HasSubstr(R"("x":12.125)"));
  EXPECT_THAT(server.posted(), HasSubstr(R"("y":-3.5)"));
  EXPECT_THAT(run_adit(server, {"reports", "correct", "7", "x=far"}).err, HasSubstr("x: expected"));
  EXPECT_THAT(run_adit(server, {"reports", "correct", "7", "w=1"}).err, HasSubstr("'w=1': expected type="));
  EXPECT_THAT(run_adit(server, {"reports", "correct", "seven", "x=1"}).err,
              HasSubstr("the report's number: expected"));
}

TEST(Actions, OnRejectedMessagesSendRequests) {
  api::RunView view = sample_view();
  view.rejected = {{.number = 3,
                    .kind = "cloud",
                    .robot = "r2",
                    .at = 940,
                    .status = 500,
                    .why = "it failed",
                    .bytes = 1200},
                   {.number = 4,
                    .kind = "state",
                    .robot = "",
                    .at = 950,
                    .status = 422,
                    .why = "no",
                    .bytes = 90,
                    .replaced = true}};
  const Server server(
      {{"GET /adit/run", Server::ok(codec::to_json(view))},
       {"POST /adit/rejected/3/send", Server::ok("{\"rejected\":3}")},
       {"POST /adit/rejected/3/discard", Server::ok("{\"rejected\":3}")},
       {"POST /adit/rejected/4/send", Server::reply("409 Conflict", "\"something newer was sent\"")}});
  const Outcome listed = run_adit(server, {"rejected"});
  EXPECT_THAT(listed.out, HasSubstr("error 500: it failed"));
  EXPECT_THAT(listed.out, HasSubstr("replaced by a newer one"));
  EXPECT_EQ(listed.exit, Exit::Attention);
  EXPECT_THAT(run_adit(server, {"rejected", "--json"}).out, HasSubstr("\"replaced\":true"));
  EXPECT_EQ(run_adit(server, {"rejected", "send", "3"}).out, "message 3 is queued again\n");
  EXPECT_EQ(run_adit(server, {"rejected", "discard", "3"}).out, "message 3 is deleted\n");
  const Outcome refused = run_adit(server, {"rejected", "send", "4"});
  EXPECT_THAT(refused.err, HasSubstr("something newer was sent"));
  EXPECT_EQ(refused.exit, Exit::Attention);
  EXPECT_THAT(run_adit(server, {"rejected", "send"}).err, HasSubstr("is missing after send"));
  EXPECT_THAT(run_adit(server, {"rejected", "keep", "3"}).err,
              HasSubstr("expected show, send or discard, got keep"));
}

/// A repeat of a recorded report would be recorded twice in a new run.
TEST(Actions, ThatBeginARunSayWhatTheyWouldDoAndAsk) {
  api::RunView view = sample_view();
  view.run_number = 9;
  view.run_id = "cave-2";
  std::vector<facts::ReportRow> reports(4, view.reports.front());
  reports[2].state = "queued";
  reports[3].state = "settled";
  const Server server({{"GET /adit/run", Server::ok(codec::to_json(view))},
                       {"GET /adit/reports?run=9", Server::ok(codec::to_json(reports))},
                       {"POST /adit/runs", Server::ok("{\"run\":10}")}});
  const Outcome outcome = run_adit(server, {"run", "new"});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_EQ(
      outcome.err,
      "adit: The Command Post still shows this run (cave-2): run clock 12:34, score 7. Adit notices most "
      "new runs by itself. This ends run 9 for good: 3 reports are recorded in it, and repeats of them "
      "would be sent again; 1 unsent report would be held. It was not done; to do it, add --yes\n");
  EXPECT_EQ(server.posted(), "");
  std::string asked;
  EXPECT_EQ(run_adit(server, {"run", "new"}, answering(false, asked)).err, "adit: no run was begun\n");
  EXPECT_EQ(server.posted(), "");
  EXPECT_EQ(run_adit(server, {"run", "new"}, answering(true, asked)).exit, Exit::Fine);
  EXPECT_THAT(asked, testing::EndsWith("Begin a new run?"));
  EXPECT_NE(server.posted(), "");
}

TEST(Actions, ComposeAReport) {
  const Server server({{"POST /adit/reports", Server::reply("202 Accepted", "{\"report\":4}")}});
  EXPECT_EQ(run_adit(server, {"reports", "compose", "type=Survivor", "x=1.5", "y=-2", "z=0"}).out,
            "report 4 is accepted: see adit reports show 4\n");
  EXPECT_THAT(server.posted(), testing::EndsWith(R"({"type":"Survivor","x":1.5,"y":-2.0,"z":0.0})"));
  EXPECT_EQ(run_adit(server, {"reports", "compose", "type=Survivor", "x=1.5", "y=-2", "x=0"}).err,
            "adit: z= is missing\n");
}

TEST(Actions, MakeTheLightsFlash) {
  const Server server({{"POST /adit/identify", Server::ok("{\"identify_until\":1005.5}")}});
  EXPECT_EQ(run_adit(server, {"identify", "5"}).out, "all lights flash for 5 s\n");
  EXPECT_THAT(server.request(), HasSubstr("Authorization: Bearer sesame-1\r\n"));
  EXPECT_THAT(server.request(), testing::EndsWith("Content-Length: 13\r\n\r\n{\"seconds\":5}"));
  EXPECT_EQ(run_adit(server, {"identify", "--json"}).out, "{\"identify_until\":1005.5}\n");
  const Server other({{"POST /adit/identify", Server::reply("403 Forbidden", "\"no\"")}});
  EXPECT_EQ(run_adit(other, {"identify"}).exit, Exit::Unable);
}

TEST(Actions, SendTheTokenOnlyToAdit) {
  const Server server({{"POST /adit/runs", Server::ok("{\"run\":2}")}});
  run_adit(server, {"run", "new", "--yes"});
  EXPECT_THAT(server.request(), HasSubstr("\r\nAuthorization: Bearer sesame-1\r\n"));
}

TEST(Actions, ContinueAfterAFailedOne) {
  const Server server(
      {{"GET /adit/reports/7", report("held")},
       {"GET /adit/reports/8", report("answered")},
       {"GET /adit/reports/9", report("held")},
       {"POST /adit/reports/7/send", Server::ok("{\"report\":7}")},
       {"POST /adit/reports/8/send",
        Server::reply("409 Conflict", "\"report 8 is answered: to send it again, resubmit it\"")},
       {"POST /adit/reports/9/send", Server::ok("{\"report\":9}")}});
  const Outcome outcome = run_adit(server, {"reports", "send", "7", "8", "9"});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_EQ(outcome.out, "report 7 is queued\nreport 9 is queued\n");
  EXPECT_EQ(outcome.err, "adit: report 8 is answered: to send it again, resubmit it\n");
}

TEST(Actions, OnAReportInDoubtNeedConfirmation) {
  const Server server({{"GET /adit/reports/3", report("in_doubt")},
                       {"POST /adit/reports/3/send", Server::ok("{\"report\":3}")}});
  std::string asked;
  const Outcome refused = run_adit(server, {"reports", "send", "3"}, answering(false, asked));
  EXPECT_EQ(
      asked,
      "report 3 (Survivor) is in doubt: if the Command Post recorded it, sending it again uses up a second "
      "report.\nSend it again?");
  EXPECT_THAT(server.request(), testing::StartsWith("GET ")) << "a POST was sent";
  EXPECT_EQ(refused.err, "adit: report 3 was not sent\n");
  EXPECT_EQ(refused.exit, Exit::Attention);

  EXPECT_EQ(run_adit(server, {"reports", "send", "3"}, answering(true, asked)).out, "report 3 is queued\n");
  EXPECT_THAT(server.request(), testing::StartsWith("POST "));
}

TEST(Actions, OnAReportInDoubtFailWithoutATerminal) {
  const Server server({{"GET /adit/reports/3", report("in_doubt", true)},
                       {"POST /adit/reports/3/send", Server::ok("{\"report\":3}")}});
  const Outcome refused = run_adit(server, {"reports", "send", "3"});
  EXPECT_THAT(server.request(), testing::StartsWith("GET ")) << "a POST was sent";
  EXPECT_THAT(refused.err, HasSubstr("Adit is asking the run's status to find out."));
  EXPECT_THAT(refused.err, testing::EndsWith("It was not done; to do it, add --yes\n"));
  EXPECT_EQ(refused.exit, Exit::Attention);
  EXPECT_EQ(run_adit(server, {"reports", "send", "3", "--yes"}).out, "report 3 is queued\n");
}

TEST(Actions, OnOtherReportsNeedNoConfirmation) {
  std::string asked;
  for (const char* const state : {"held", "rejected", "withdrawn"}) {
    const Server server({{"GET /adit/reports/3", report(state)},
                         {"POST /adit/reports/3/send", Server::ok("{\"report\":3}")}});
    EXPECT_EQ(run_adit(server, {"reports", "send", "3"}, answering(false, asked)).exit, Exit::Fine) << state;
  }
  EXPECT_EQ(asked, "");
}

TEST(Actions, OnAnUnknownReportFail) {
  const Server server(
      {{"POST /adit/reports/8/settle", Server::reply("404 Not Found", "\"there is no report 8\"")}});
  const Outcome outcome = run_adit(server, {"reports", "settle", "8"});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_EQ(outcome.err, "adit: there is no report 8\n");
}

TEST(Actions, StopAfterAWrongToken) {
  const Server server(
      Server::reply("401 Unauthorized", "\"Authorization: expected Bearer and the team's token\""));
  const Outcome outcome = run_adit(server, {"reports", "send", "7", "8"});
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_THAT(outcome.err, testing::MatchesRegex("adit: Adit rejects the token in /.*\n"));
}

TEST(Actions, MayBeDoneIfTheAnswerIsLost) {
  const Server server("");
  const Outcome outcome = run_adit(server, {"reports", "resubmit", "7"});
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_THAT(outcome.err, HasSubstr("the action may have been done: see adit reports\n"));
  EXPECT_THAT(run_adit(server, {"reports", "send", "7", "--yes"}).err,
              HasSubstr("see adit reports show 7\n"));
}

TEST(Actions, AreNotDoneIfAditIsUnreachable) {
  std::string at;
  {
    at = Server("").at();
  }
  const TokenFile token;
  const Outcome outcome =
      run(std::vector<std::string_view>{"run", "new", "--yes", "--at", at, "--token-file", token.path()});
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_THAT(outcome.err, Not(HasSubstr("may have been done")));
}

TEST(Actions, SendNothingIfTheTokenIsUnreadable) {
  const Server server({{"POST /adit/runs", Server::ok("{\"run\":2}")}});
  const Outcome outcome =
      run(std::vector<std::string_view>{"run", "new", "--at", server.at(), "--token-file", "/none"});
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_EQ(outcome.err, "adit: /none: No such file or directory\n");
}

}  // namespace
}  // namespace adit::cli
