#include "api/report_routes.hpp"

#include <gmock/gmock.h>

#include <array>
#include <nlohmann/json.hpp>

#include "api/api.hpp"
#include "api/doubles.hpp"
#include "api/reports_csv.hpp"
#include "intake/raw_client.hpp"
#include "intake/served.hpp"

namespace adit::api {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

const std::vector<intake::Header> kGood = {kByToken, {"Content-Type", "application/json"}};

class ReportRoutesTest : public testing::Test {
 protected:
  ReportRoutesTest() {
    for (const std::int64_t number : {7, 12}) {
      ReportDetail detail;
      detail.row.number = number;
      detail.row.type = "Survivor";
      detail.row.run = 2;
      detail.history = {{1000, "waiting", ""}, {1001.5, "in doubt", "the connection was lost"}};
      detail.answer = "{\"score_change\": 1}";
      source.details[number] = detail;
    }
  }

  intake::Answer compose(const std::string& body) {
    auto responder = std::make_shared<FakeResponder>();
    const auto exchange = api.open(FakeHead{"POST", "/adit/reports", kGood, body.size()}, responder, {});
    if (exchange) {
      exchange->on_body({reinterpret_cast<const std::uint8_t*>(body.data()), body.size()});
      exchange->on_end();
    }
    return responder->answered.value_or(intake::Answer{});
  }
  intake::Answer ask(const std::string& method, const std::string& path,
                     std::vector<intake::Header> headers = {kByToken}, std::size_t body = 0) {
    auto responder = std::make_shared<FakeResponder>();
    const auto exchange = api.open(FakeHead{method, path, std::move(headers), body}, responder, {});
    EXPECT_EQ(exchange == nullptr, responder->answered.has_value());
    if (exchange) {
      const std::vector<std::uint8_t> bytes(body);
      exchange->on_body(bytes);
      exchange->on_end();
    }
    EXPECT_TRUE(responder->answered);
    return responder->answered.value_or(intake::Answer{});
  }
  intake::Answer post(const std::string& path, std::vector<intake::Header> headers = kGood,
                      std::size_t body = 0) {
    return ask("POST", path, std::move(headers), body);
  }

  loop::Loop loop;
  FakeSource source;
  FakeOperator judge;
  FakeKeys keys;
  Api api{loop, source, judge, keys, {token("team-1"), token("scoring-1")}};
};

TEST_F(ReportRoutesTest, GiveThoseOfOneRun) {
  source.details[7].row.run = 1;
  source.now.run_number = 2;
  const auto numbers = [&](const std::string& run) {
    std::vector<std::int64_t> listed;
    for (const json& report : json::parse(ask("GET", "/adit/reports?run=" + run).body)) {
      listed.push_back(report["number"]);
    }
    return listed;
  };
  EXPECT_THAT(numbers("1"), ElementsAre(7));
  EXPECT_THAT(numbers("present"), ElementsAre(12));
  EXPECT_THAT(numbers("all"), ElementsAre(7, 12));
  EXPECT_THAT(numbers("3"), IsEmpty());
  for (const char* path : {"/adit/reports?run=last", "/adit/reports.csv?run=1.5"}) {
    const auto refused = ask("GET", path);
    EXPECT_EQ(refused.status, icd::Status::BadRequest) << path;
    EXPECT_EQ(json::parse(refused.body), "run: expected a run's number, present or all");
  }
}

TEST_F(ReportRoutesTest, GiveAllReportsAsJsonThatNobodyKeeps) {
  const auto answer = ask("GET", "/adit/reports");
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

TEST_F(ReportRoutesTest, GiveAllReportsAsAFileForSpreadsheets) {
  const auto answer = ask("GET", "/adit/reports.csv");
  EXPECT_EQ(answer.content_type, "text/csv; charset=utf-8; header=present");
  EXPECT_EQ(header(answer, "Content-Disposition"), "attachment; filename=\"adit-reports.csv\"");
  EXPECT_EQ(header(answer, "X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(answer.body, write_reports_csv(source.reports()));
}

TEST_F(ReportRoutesTest, GiveAReportWithItsHistoryAndItsAnswer) {
  const json report = json::parse(ask("GET", "/adit/reports/12").body);
  EXPECT_EQ(report["number"], 12);
  EXPECT_EQ(report["history"],
            (json{{{"at", 1000.0}, {"state", "waiting"}, {"note", ""}},
                  {{"at", 1001.5}, {"state", "in doubt"}, {"note", "the connection was lost"}}}));
  EXPECT_EQ(report["answer"], "{\"score_change\": 1}");
}

TEST_F(ReportRoutesTest, PassOnTheOperatorsWord) {
  EXPECT_EQ(post("/adit/reports/7/send").body, "{\"report\":7}");
  post("/adit/reports/12/withdraw");
  post("/adit/reports/12/hold");
  post("/adit/reports/7/done");
  EXPECT_THAT(judge.judged, ElementsAre(Pair(7, Action::Send), Pair(12, Action::Withdraw),
                                        Pair(12, Action::Hold), Pair(7, Action::CallDone)));
  judge.outcome = 13;
  const auto answer = post("/adit/reports/7/resubmit");
  EXPECT_EQ(answer.status, icd::Status::Ok);
  EXPECT_EQ(answer.body, "{\"report\":13}");
  EXPECT_THAT(judge.judged.back(), Pair(7, Action::Resubmit));
}

TEST_F(ReportRoutesTest, DeclareANewRun) {
  EXPECT_EQ(post("/adit/runs").body, "{\"run\":2}");
  EXPECT_EQ(judge.run, 2);
}

TEST_F(ReportRoutesTest, TakeAReportThatTheOperatorComposed) {
  const auto answer = compose(R"({"type":"Drill","x":1.5,"y":-2,"z":0})");
  EXPECT_EQ(static_cast<int>(answer.status), 202);
  EXPECT_EQ(answer.body, "{\"report\":41}");
  compose(R"({"type":"rope","x":0,"y":0,"z":0,"resubmit":true})");
  ASSERT_EQ(judge.reported.size(), 2u);
  EXPECT_EQ(judge.reported[0], std::pair(icd::ArtifactReport{"Drill", {1.5, -2, 0}}, false));
  EXPECT_EQ(judge.reported[1], std::pair(icd::ArtifactReport{"rope", {0, 0, 0}}, true));
}

TEST_F(ReportRoutesTest, NameTheFieldOfAComposedReportThatIsWrong) {
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
  EXPECT_THAT(judge.reported, IsEmpty());
}

TEST_F(ReportRoutesTest, SayWhyAComposedReportWasNotTaken) {
  judge.outcome = std::unexpected("1000 reports wait already; this one was not taken");
  const auto answer = compose(R"({"type":"Rope","x":0,"y":0,"z":0})");
  EXPECT_EQ(answer.status, icd::Status::Conflict);
  EXPECT_EQ(json::parse(answer.body), "1000 reports wait already; this one was not taken");
}

TEST_F(ReportRoutesTest, SayWhyAActionCannotBe) {
  judge.outcome = std::unexpected("report 7 is answered: there is nothing to withdraw");
  const auto answer = post("/adit/reports/7/withdraw");
  EXPECT_EQ(answer.status, icd::Status::Conflict);
  EXPECT_EQ(json::parse(answer.body), "report 7 is answered: there is nothing to withdraw");
}

TEST_F(ReportRoutesTest, KnowNoOtherReportsAndNoOtherActions) {
  for (const auto& answer : {ask("GET", "/adit/reports/8"), post("/adit/reports/8/send")}) {
    EXPECT_EQ(answer.status, icd::Status::NotFound);
    EXPECT_EQ(json::parse(answer.body), "there is no report 8");
  }
  for (const char* path :
       {"/adit/reports/", "/adit/reports/7/", "/adit/reports/x", "/adit/reports/7x",
        "/adit/reports/7/history", "/adit/reports/99999999999999999999", "/adit/reports/7/send/"}) {
    EXPECT_EQ(ask("GET", path).status, icd::Status::NotFound) << path;
    EXPECT_EQ(post(path).status, icd::Status::MethodNotAllowed) << path;
  }
  EXPECT_THAT(judge.judged, IsEmpty());
}

TEST_F(ReportRoutesTest, DoNothingWithoutAToken) {
  for (const char* authorization :
       {"", "Bearer", "Bearer wrong", "Bearer team-", "Basic team-1", "Bearer team-1x"}) {
    for (const char* path : {"/adit/reports/7/send", "/adit/runs"}) {
      const auto answer =
          post(path, {{"Authorization", authorization}, {"Content-Type", "application/json"}});
      EXPECT_EQ(answer.status, icd::Status::Unauthorized) << authorization;
      EXPECT_EQ(header(answer, "WWW-Authenticate"), "Bearer");
    }
  }
  EXPECT_THAT(judge.judged, IsEmpty());
  EXPECT_EQ(judge.run, 1);
}

TEST_F(ReportRoutesTest, TakeAnyOfTheTokens) {
  EXPECT_EQ(post("/adit/runs", {{"Authorization", "bearer scoring-1"}, {"Content-Type", "application/json"}})
                .status,
            icd::Status::Ok);
}

/// What a form or a script of another web page can send without being asked (Fetch, CORS-safelisted).
TEST_F(ReportRoutesTest, LetNoOtherWebPageDoAAction) {
  for (const char* type :
       {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x"}) {
    const auto answer = post("/adit/runs", {{"Authorization", "Bearer team-1"}, {"Content-Type", type}});
    EXPECT_EQ(answer.status, icd::Status::UnprocessableEntity) << type;
  }
  const auto preflight = ask("OPTIONS", "/adit/reports/7/send",
                             {{"Origin", "http://evil.example"}, {"Access-Control-Request-Method", "POST"}});
  EXPECT_EQ(preflight.status, icd::Status::Forbidden);
  for (const auto& answer : {preflight, post("/adit/runs"), ask("GET", "/adit/reports")}) {
    for (const auto& [name, value] : answer.headers) EXPECT_FALSE(name.starts_with("Access-Control")) << name;
  }
  EXPECT_THAT(judge.judged, IsEmpty());
  EXPECT_EQ(judge.run, 2);
}

TEST_F(ReportRoutesTest, TakeAnyBodyButAnEndlessOne) {
  EXPECT_EQ(post("/adit/reports/7/send", kGood, 65536).status, icd::Status::Ok);
  EXPECT_EQ(post("/adit/reports/7/send", kGood, 65537).status, icd::Status::ContentTooLarge);

  auto responder = std::make_shared<FakeResponder>();
  const auto chunked = api.open(FakeHead{"POST", "/adit/reports/7/send", kGood, std::nullopt}, responder, {});
  ASSERT_NE(chunked, nullptr);
  const std::array<std::uint8_t, 40000> piece{};
  chunked->on_body(piece);
  EXPECT_FALSE(responder->answered);
  chunked->on_body(piece);
  ASSERT_TRUE(responder->answered);
  EXPECT_EQ(responder->answered->status, icd::Status::ContentTooLarge);
  EXPECT_EQ(judge.judged.size(), 1u);
}

TEST_F(ReportRoutesTest, OnlyReadWhereTheyShow) {
  for (const char* path : {"/adit/reports.csv", "/adit/reports/7"}) {
    for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS"}) {
      const auto answer = ask(method, path, kGood);
      EXPECT_EQ(answer.status, icd::Status::MethodNotAllowed) << method << ' ' << path;
      EXPECT_EQ(header(answer, "Allow"), "GET, HEAD");
    }
  }
  for (const char* method : {"GET", "HEAD", "PUT", "DELETE"}) {
    EXPECT_EQ(header(ask(method, "/adit/runs", kGood), "Allow"), "POST") << method;
  }
  EXPECT_EQ(header(ask("PUT", "/adit/reports", kGood), "Allow"), "GET, HEAD, POST");
}

TEST(ReportRoutesOnAServer, DoAActionAndShowIt) {
  std::unique_ptr<Api> api;
  Forward forward;
  FakeOperator judge;
  FakeKeys keys;
  FakeSource source;
  source.details[7].row.number = 7;
  intake::Served served{forward};
  served.on_loop([&] {
    api = std::make_unique<Api>(served.loop(), source, judge, keys, std::vector{token()});
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
