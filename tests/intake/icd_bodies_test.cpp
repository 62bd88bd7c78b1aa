#include <gtest/gtest.h>

#include "codec/deflated.hpp"
#include "intake/team.hpp"

namespace adit::intake {
namespace {

using codec::test::gzipped;
using std::chrono::milliseconds;

std::string cbor_of_json(std::string_view json) {
  std::string bytes;
  nlohmann::json::to_cbor(nlohmann::json::parse(json), bytes);
  return bytes;
}

TEST(IcdBodies, MayBeJsonOrCborWithGzip) {
  Team team;
  const std::pair<std::string_view, std::string_view> posts[] = {{"/state/update", kStateBody},
                                                                 {"/markers/update", kMarkersBody}};
  for (const auto& [path, json] : posts) {
    const std::string cbor = cbor_of_json(json);
    for (const std::string& text :
         {authorized("POST", path, kJsonType, json), authorized("POST", path, kCborType, cbor),
          authorized("POST", path, std::string(kJsonType) + kGzip, gzipped(json)),
          authorized("POST", path, std::string(kCborType) + kGzip, gzipped(cbor))}) {
      const auto reply = team.ask(text);
      ASSERT_TRUE(reply);
      EXPECT_EQ(reply->status, 200) << reply->body;
      EXPECT_EQ(reply->body, "null");
      EXPECT_EQ(reply->header("content-type"), "application/json");
      EXPECT_EQ(reply->header("access-control-allow-origin"), "*");
    }
  }
  team.served.on_loop([&] {
    EXPECT_EQ(team.message_handler.states.size(), 4u);
    EXPECT_EQ(team.message_handler.markers.size(), 4u);
    EXPECT_EQ(team.message_handler.states.at(0).poses.at(0).name.text(), "r1");
    EXPECT_EQ(team.message_handler.senders.at(0).bytes, kStateBody.size());
    EXPECT_EQ(team.message_handler.senders.at(0).address, "127.0.0.1");
  });
}

TEST(IcdBodies, OfReportsAreAnsweredByTheDesk) {
  Team team;
  for (const auto& [headers, body] : {std::pair(std::string(kJsonType), std::string(kReportBody)),
                                      std::pair(std::string(kJsonType) + kGzip, gzipped(kReportBody))}) {
    RawClient client(team.served.port());
    client.send(authorized("POST", "/api/artifact_reports", headers, body));
    ASSERT_TRUE(team.served.eventually([&] { return team.message_handler.responders.size() == 1; }));
    EXPECT_FALSE(client.reply(milliseconds(20)));
    team.served.on_loop([&] {
      EXPECT_EQ(team.message_handler.reports.back(), (icd::ArtifactReport{"Backpack", {1.5, -2, 0}}));
      team.message_handler.responders[0]->answer(
          {.status = icd::Status::Created, .body = R"({"id": 1})", .headers = {{"X-Post", "1"}}});
      team.message_handler.responders.clear();
    });
    const auto reply = client.reply();
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 201);
    EXPECT_EQ(reply->body, R"({"id": 1})");
    EXPECT_EQ(reply->header("x-post"), "1");
    EXPECT_EQ(reply->header("access-control-allow-origin"), "*");
  }
}

TEST(IcdBodies, OfReportsMayHaveAnInvalidRobotName) {
  Team team;
  RawClient client(team.served.port());
  client.send(authorized("POST", "/api/artifact_reports", kJsonType,
                         R"({"x": 1.5, "y": -2, "z": 0, "type": "Backpack", "name": "no robot"})"));
  ASSERT_TRUE(team.served.eventually([&] { return team.message_handler.responders.size() == 1; }));
  team.served.on_loop([&] {
    EXPECT_EQ(team.message_handler.reports.back(), (icd::ArtifactReport{"Backpack", {1.5, -2, 0}}));
    ASSERT_EQ(team.message_handler.left_out_of_reports.size(), 1u);
    EXPECT_TRUE(team.message_handler.left_out_of_reports[0].starts_with("name: expected 1 to 10 letters"));
    team.message_handler.responders[0]->answer({.body = "null", .headers = {}});
  });
  EXPECT_EQ(client.reply()->status, 200);
}

TEST(IcdBodies, AreIgnoredByAStatusRequest) {
  Team team;
  RawClient client(team.served.port());
  for (const std::string_view body : {"", "ignored"}) {
    for (const std::string_view method : {"GET", "HEAD"}) {
      client.send(authorized(method, "/api/status", {}, body));
      ASSERT_TRUE(team.served.eventually([&] { return team.message_handler.responders.size() == 1; }))
          << method;
      team.served.on_loop([&] {
        team.message_handler.responders[0]->answer({.body = R"({"score": 1})", .headers = {}});
        team.message_handler.responders.clear();
      });
      const auto reply = client.reply(std::chrono::seconds(10), method == "HEAD");
      ASSERT_TRUE(reply);
      EXPECT_EQ(reply->status, 200);
      EXPECT_EQ(reply->header("content-length"), "12");
      EXPECT_EQ(reply->body, method == "GET" ? R"({"score": 1})" : "");
    }
  }
}

TEST(IcdBodies, AreRejectedWithASentenceIfTheyAreWrong) {
  Team team;
  struct Case {
    std::string_view path, body;
    int status;
    std::string_view names;
  };
  const Case cases[] = {
      {"/state/update", "{", 400, ""},
      {"/state/update", "{}", 422, "poses"},
      {"/markers/update", R"({"markers": 1})", 422, "markers"},
      {"/api/artifact_reports", R"({"x": 1, "y": 2, "type": "Rope"})", 422, "z"},
      {"/map/update", "{}", 422, ""},
      {"/map/update", R"({"type": "Octree", "msg": {}})", 422, "type"},
  };
  for (const Case& c : cases) {
    const auto reply = team.ask(authorized("POST", c.path, kJsonType, c.body));
    ASSERT_TRUE(reply) << c.path << c.body;
    EXPECT_EQ(reply->status, c.status) << c.body << reply->body;
    EXPECT_TRUE(is_json_string(reply->body)) << reply->body;
    EXPECT_NE(reply->body.find(c.names), std::string::npos) << reply->body;
    EXPECT_EQ(reply->header("access-control-allow-origin"), "*");
  }
  team.served.on_loop([&] {
    EXPECT_EQ(team.message_handler.refusals.size(), std::size(cases));
    EXPECT_TRUE(team.message_handler.states.empty() && team.message_handler.markers.empty() &&
                team.message_handler.reports.empty() && team.message_handler.maps.empty());
  });
}

TEST(IcdBodies, AreRejectedAtTheFirstError) {
  Team team;
  for (const std::string_view path : {"/state/update", "/map/update"}) {
    RawClient client(team.served.port());
    client.send(authorized("POST", path, std::string(kJsonType) + "Content-Length: 1000000\r\n") + "{]");
    const auto reply = client.reply();
    ASSERT_TRUE(reply) << path;
    EXPECT_EQ(reply->status, 400) << path;
  }
}

TEST(IcdBodies, AreReadToTheirEndAfterARejection) {
  Team team;
  const std::string rest(20u << 20,
                         ' ');  // more than the sockets hold; the client reads no answer before its end
  for (const std::string_view framing : {"Content-Length: 20971522\r\n", "Transfer-Encoding: chunked\r\n"}) {
    const bool chunked = framing.starts_with("Transfer");
    RawClient client(team.served.port());
    client.send(authorized("POST", "/map/update", std::string(kJsonType) + std::string(framing)));
    ASSERT_TRUE(client.send(chunked ? "2\r\n{]\r\n1400000\r\n" : "{]"));
    ASSERT_TRUE(client.send(rest)) << framing;
    if (chunked) client.send("\r\n0\r\n\r\n");
    const auto reply = client.reply();
    ASSERT_TRUE(reply) << framing;
    EXPECT_EQ(reply->status, 400) << framing;
    client.half_close();
    EXPECT_TRUE(client.closes()) << framing;
  }
}

TEST(IcdBodies, OfUnauthenticatedClientsAreNotReadToTheEnd) {
  Team team;
  RawClient client(team.served.port());
  client.send("POST /map/update HTTP/1.1\r\nHost: x\r\nContent-Length: 20971522\r\n\r\n");
  EXPECT_FALSE(client.send(std::string(20u << 20, ' ')));
}

TEST(IcdBodies, AreRejectedIfTheyInflateTooFar) {
  Team team;
  const std::string bomb = gzipped("{\"poses\": [" + std::string(3u << 20, ' ') + "]}");
  const auto reply = team.ask(authorized("POST", "/state/update", std::string(kJsonType) + kGzip, bomb));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 413);
}

/// Three poses; the second has no name.
const std::string kOneBadPose = [] {
  auto state = nlohmann::json::parse(kStateBody);
  const auto pose = state["poses"][0];
  state["poses"] = {pose, pose, pose};
  state["poses"][1].erase("name");
  state["poses"][2]["name"] = "r3";
  return state.dump();
}();

TEST(IcdBodies, AreAcceptedForTheirGoodParts) {
  Team team;
  const auto reply = team.ask(authorized("POST", "/state/update", kJsonType, kOneBadPose));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 422);
  EXPECT_EQ(reply->body, "\"poses[1].name: missing (the other 2 were accepted)\"");
  auto markers = nlohmann::json::parse(kMarkersBody);
  markers["markers"].push_back(7);
  EXPECT_EQ(team.ask(authorized("POST", "/markers/update", kJsonType, markers.dump()))->status, 422);
  team.served.on_loop([&] {
    ASSERT_EQ(team.message_handler.states.size(), 1u);
    ASSERT_EQ(team.message_handler.states[0].poses.size(), 2u);
    EXPECT_EQ(team.message_handler.states[0].poses[1].name.text(), "r3");
    ASSERT_EQ(team.message_handler.markers.size(), 1u);
    EXPECT_EQ(team.message_handler.markers[0].markers.size(), markers["markers"].size() - 1);
    ASSERT_EQ(team.message_handler.refusals.size(), 2u);
    EXPECT_EQ(team.message_handler.refusals[0].first, icd::Uri::StateUpdate);
    EXPECT_EQ(team.message_handler.refusals[0].second.status, icd::Status::UnprocessableEntity);
    EXPECT_EQ(team.message_handler.refusals[0].second.sentence,
              "poses[1].name: missing (the other 2 were accepted)");
  });
}

TEST(IcdBodies, HaveTheDesksAnswerIfItRejectsGoodParts) {
  Team team;
  team.served.on_loop([&] { team.message_handler.full = {icd::Status::TooManyRequests, "full"}; });
  const auto reply = team.ask(authorized("POST", "/state/update", kJsonType, kOneBadPose));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 429);
  EXPECT_EQ(reply->body, "\"full\"");
}

TEST(IcdBodies, AreRejectedByAFullDesk) {
  Team team;
  team.served.on_loop(
      [&] { team.message_handler.full = {icd::Status::TooManyRequests, "the queue is full"}; });
  for (const auto& [path, body] :
       {std::pair("/state/update", std::string(kStateBody)),
        std::pair("/markers/update", std::string(kMarkersBody)), std::pair("/map/update", grid_body(4, 4))}) {
    const auto reply = team.ask(authorized("POST", path, kJsonType, body));
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 429);
    EXPECT_EQ(reply->body, "\"the queue is full\"");
  }
}

TEST(IcdBodies, OfSeveralRequestsMayShareAConnection) {
  Team team;
  RawClient client(team.served.port());
  const std::string state = authorized("POST", "/state/update", kJsonType, kStateBody);
  const std::string map = authorized("POST", "/map/update", kJsonType, grid_body(30, 20));
  client.send(state + map + authorized("POST", "/state/update", kJsonType, "{}") + map + state);
  for (const int status : {200, 200, 422, 200, 200}) {
    const auto reply = client.reply();
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, status);
  }
}

}  // namespace
}  // namespace adit::intake
