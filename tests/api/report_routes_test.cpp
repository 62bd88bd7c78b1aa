#include "api/report_routes.hpp"

#include <gmock/gmock.h>

#include <array>
#include <nlohmann/json.hpp>

#include "api/on_page.hpp"
#include "api/reports_csv.hpp"
#include "intake/raw_client.hpp"
#include "intake/served.hpp"

namespace adit::api {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

class ReportRoutesTest : public OnPage {
 protected:
  ReportRoutesTest() {
    for (const std::int64_t number : {7, 12}) {
      ReportDetail detail;
      detail.row.number = number;
      detail.row.type = "Survivor";
      detail.row.run = 2;
      detail.history = {{1000, "queued", ""}, {1001.5, "in_doubt", "the connection was lost"}};
      detail.answer = "{\"score_change\": 1}";
      source.details[number] = detail;
    }
  }

  std::optional<intake::Answer>& begin(const std::string& target) {
    send(open("GET", target, {kByToken}, 0).get(), "");
    return responder->answered;
  }
  intake::Answer compose(const std::string& body) { return post("/adit/reports", body); }
};

TEST_F(ReportRoutesTest, GiveReportsOfOneRun) {
  source.details[7].row.run = 1;
  source.now.run_number = 2;
  const auto numbers = [&](const std::string& run) {
    std::vector<std::int64_t> listed;
    for (const json& report : json::parse(get("/adit/reports?run=" + run).body)) {
      listed.push_back(report["number"]);
    }
    return listed;
  };
  EXPECT_THAT(numbers("1"), ElementsAre(7));
  EXPECT_THAT(numbers("present"), ElementsAre(12));
  EXPECT_THAT(numbers("all"), ElementsAre(7, 12));
  EXPECT_THAT(numbers("3"), IsEmpty());
  for (const char* path : {"/adit/reports?run=last", "/adit/reports.csv?run=1.5"}) {
    const auto refused = get(path);
    EXPECT_EQ(refused.status, icd::Status::BadRequest) << path;
    EXPECT_EQ(json::parse(refused.body), "run: expected a run's number, present or all");
  }
}

TEST_F(ReportRoutesTest, GiveAllReportsAsUncachedJson) {
  const auto answer = get("/adit/reports");
  EXPECT_EQ(answer.status, icd::Status::Ok);
  EXPECT_EQ(answer.content_type, "application/json");
  EXPECT_EQ(header(answer, "Cache-Control"), "no-store");
  const json reports = json::parse(answer.body);
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_EQ(reports[0]["number"], 7);
  EXPECT_EQ(reports[1]["number"], 12);
  EXPECT_EQ(reports[1]["run"], 2);
  EXPECT_EQ(reports[1]["asking"], false);
  EXPECT_EQ(reports[1]["reconciled"], false);
  EXPECT_EQ(reports[1]["same_as"], 0);
}

TEST_F(ReportRoutesTest, WriteThousandsInManyTurnsOfTheLoop) {
  for (std::int64_t number = 1; number <= 1000; ++number) source.details[number].row.number = number;
  std::optional<intake::Answer>& answer = begin("/adit/reports");
  int turns = 0;
  for (; !answer; ++turns) loop.turn(std::chrono::seconds(1));
  EXPECT_GT(turns, 10);
  const json reports = json::parse(answer->body);
  ASSERT_EQ(reports.size(), 1000u);
  EXPECT_EQ(reports[999]["number"], 1000);
}

TEST_F(ReportRoutesTest, GiveAllReportsAsCsv) {
  const auto answer = get("/adit/reports.csv");
  EXPECT_EQ(answer.content_type, "text/csv; charset=utf-8; header=present");
  EXPECT_EQ(header(answer, "Content-Disposition"), "attachment; filename=\"adit-reports.csv\"");
  EXPECT_EQ(header(answer, "X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(answer.body, csv_header() + csv_line(source.details[7].row) + csv_line(source.details[12].row));
}

TEST_F(ReportRoutesTest, GiveAReportWithItsHistoryAndAnswer) {
  const json report = json::parse(get("/adit/reports/12").body);
  EXPECT_EQ(report["number"], 12);
  EXPECT_EQ(report["history"],
            (json{{{"at", 1000.0}, {"state", "queued"}, {"note", ""}},
                  {{"at", 1001.5}, {"state", "in_doubt"}, {"note", "the connection was lost"}}}));
  EXPECT_EQ(report["answer"], "{\"score_change\": 1}");
}

TEST_F(ReportRoutesTest, PassOnTheOperatorsAction) {
  EXPECT_EQ(post("/adit/reports/7/send").body, "{\"report\":7}");
  post("/adit/reports/12/withdraw");
  post("/adit/reports/12/hold");
  post("/adit/reports/7/settle");
  EXPECT_THAT(decisions.decided, ElementsAre(Pair(7, Action::Send), Pair(12, Action::Withdraw),
                                             Pair(12, Action::Hold), Pair(7, Action::Settle)));
  decisions.outcome = 13;
  const auto answer = post("/adit/reports/7/resubmit");
  EXPECT_EQ(answer.status, icd::Status::Ok);
  EXPECT_EQ(answer.body, "{\"report\":13}");
  EXPECT_THAT(decisions.decided.back(), Pair(7, Action::Resubmit));
}

TEST_F(ReportRoutesTest, AcceptAReportFromTheOperator) {
  const auto answer = compose(R"({"type":"Drill","x":1.5,"y":-2,"z":0})");
  EXPECT_EQ(static_cast<int>(answer.status), 202);
  EXPECT_EQ(answer.body, "{\"report\":41}");
  compose(R"({"type":"rope","x":0,"y":0,"z":0,"resubmit":true})");
  ASSERT_EQ(decisions.reported.size(), 2u);
  EXPECT_EQ(decisions.reported[0], std::pair(icd::ArtifactReport{"Drill", {1.5, -2, 0}}, false));
  EXPECT_EQ(decisions.reported[1], std::pair(icd::ArtifactReport{"rope", {0, 0, 0}}, true));
}

TEST_F(ReportRoutesTest, CorrectAReportByTheRulesOfANewOne) {
  const auto correct = [&](const char* body) { return post("/adit/reports/7/correct", body); };
  const auto answer = correct(R"({"type":"Drill","x":1.5,"y":-2,"z":0})");
  EXPECT_EQ(answer.status, icd::Status::Ok);
  EXPECT_EQ(answer.body, "{\"report\":42}");
  EXPECT_THAT(decisions.corrected, ElementsAre(Pair(7, icd::ArtifactReport{"Drill", {1.5, -2, 0}})));
  EXPECT_THAT(correct(R"({"type":"Lamp","x":0,"y":0,"z":0})").body,
              testing::HasSubstr("type: expected one of"));
  EXPECT_THAT(correct(R"({"type":"Rope","x":0,"y":"1","z":0})").body, testing::HasSubstr("y: expected"));
  EXPECT_EQ(correct("{").status, icd::Status::BadRequest);
  EXPECT_EQ(decisions.corrected.size(), 1u);
  decisions.outcome = std::unexpected("report 7 is in doubt: only a held report can be corrected");
  EXPECT_EQ(correct(R"({"type":"Drill","x":1.5,"y":-2,"z":0})").status, icd::Status::Conflict);
  EXPECT_EQ(post("/adit/reports/8/correct", R"({"type":"Drill","x":1.5,"y":-2,"z":0})").status,
            icd::Status::NotFound);
}

TEST_F(ReportRoutesTest, DropAnInvalidRobotNameAndTellWhy) {
  EXPECT_EQ(compose(R"({"type":"Drill","x":1.5,"y":-2,"z":0,"name":"spot1"})").body, "{\"report\":41}");
  EXPECT_EQ(compose(R"({"type":"Drill","x":9,"y":-2,"z":0,"name":7})").body,
            R"({"report":41,"left_out":"name: expected a string, got a whole number"})");
  ASSERT_EQ(decisions.reported.size(), 2u);
  EXPECT_EQ(decisions.reported[0].first.robot, icd::RobotName::parse("spot1"));
  EXPECT_EQ(decisions.reported[1].first.robot, std::nullopt);
}

TEST_F(ReportRoutesTest, NameTheWrongFieldOfAComposedReport) {
  const std::pair<const char*, const char*> wrong[] = {
      {R"({"type":"Lamp","x":0,"y":0,"z":0})", "type: expected one of"},
      {R"({"type":"Rope","x":"0","y":0,"z":0})", "x: expected"},
      {R"({"type":"Rope","x":0,"y":0})", "z: missing"},
      {R"({"type":"Rope","x":0,"y":0,"z":0,"resubmit":"no"})", "resubmit: expected"},
      {"[]", "expected"}};
  for (const auto& [body, sentence] : wrong) {
    const auto answer = compose(body);
    EXPECT_EQ(answer.status, icd::Status::UnprocessableEntity) << body;
    EXPECT_THAT(answer.body, testing::HasSubstr(sentence));
  }
  EXPECT_EQ(compose("{").status, icd::Status::BadRequest);
  EXPECT_THAT(decisions.reported, IsEmpty());
}

TEST_F(ReportRoutesTest, TellWhyAComposedReportWasRejected) {
  decisions.outcome = std::unexpected("1000 reports are queued already; this report was not accepted");
  const auto answer = compose(R"({"type":"Rope","x":0,"y":0,"z":0})");
  EXPECT_EQ(answer.status, icd::Status::Conflict);
  EXPECT_EQ(json::parse(answer.body), "1000 reports are queued already; this report was not accepted");
}

TEST_F(ReportRoutesTest, TellWhyAnActionFails) {
  decisions.outcome = std::unexpected("report 7 is answered: it is finished and cannot be withdrawn");
  const auto answer = post("/adit/reports/7/withdraw");
  EXPECT_EQ(answer.status, icd::Status::Conflict);
  EXPECT_EQ(json::parse(answer.body), "report 7 is answered: it is finished and cannot be withdrawn");
}

TEST_F(ReportRoutesTest, RejectUnknownReportsAndActions) {
  for (const auto& answer : {get("/adit/reports/8"), post("/adit/reports/8/send")}) {
    EXPECT_EQ(answer.status, icd::Status::NotFound);
    EXPECT_EQ(json::parse(answer.body), "there is no report 8");
  }
  for (const char* path :
       {"/adit/reports/", "/adit/reports/7/", "/adit/reports/x", "/adit/reports/7x",
        "/adit/reports/7/history", "/adit/reports/99999999999999999999", "/adit/reports/7/send/"}) {
    EXPECT_EQ(get(path).status, icd::Status::NotFound) << path;
  }
  EXPECT_THAT(decisions.decided, IsEmpty());
}

TEST_F(ReportRoutesTest, AcceptEachToken) {
  EXPECT_EQ(request("POST", "/adit/runs",
                    {{"Authorization", "bearer scoring-1"}, {"Content-Type", "application/json"}})
                .status,
            icd::Status::Ok);
}

TEST_F(ReportRoutesTest, LimitTheBody) {
  EXPECT_EQ(post("/adit/reports/7/send", std::string(65536, ' ')).status, icd::Status::Ok);
  const auto chunked = open("POST", "/adit/reports/7/send", kJsonByToken, std::nullopt);
  ASSERT_NE(chunked, nullptr);
  const std::array<std::uint8_t, 40000> piece{};
  chunked->on_body(piece);
  EXPECT_FALSE(responder->answered);
  chunked->on_body(piece);
  ASSERT_TRUE(responder->answered);
  EXPECT_EQ(responder->answered->status, icd::Status::ContentTooLarge);
  EXPECT_EQ(decisions.decided.size(), 1u);
}

TEST(ReportRoutesOnAServer, ApplyAndShowAnAction) {
  std::unique_ptr<Api> api;
  Forward forward;
  Doubles doubles;
  doubles.source.details[7].row.number = 7;
  intake::Served served{forward};
  served.on_loop([&] {
    api = std::make_unique<Api>(served.loop(), doubles.served(), std::vector{token()});
    forward.to = api.get();
  });
  intake::RawClient client{served.port()};
  const std::string good = "Authorization: Bearer team-1\r\nContent-Type: application/json\r\n";
  client.send(intake::request("POST", "/adit/reports/7/send", good));
  auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 200);
  EXPECT_EQ(reply->body, "{\"report\":7}");
  client.send(intake::request("POST", "/adit/runs", good, "{}"));
  reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->body, "{\"run\":2}");
  client.send(intake::request("POST", "/adit/runs"));
  reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 401);
  served.on_loop([&] { forward.to = nullptr, api.reset(); });
}

}  // namespace
}  // namespace adit::api
