#include "intake/icd_routes.hpp"

#include <gtest/gtest.h>

#include "intake/team.hpp"

namespace adit::intake {
namespace {

using std::chrono::milliseconds;

struct Post {
  std::string_view path, body;
};
constexpr Post kPosts[] = {{"/api/artifact_reports", kReportBody},
                           {"/state/update", kStateBody},
                           {"/markers/update", kMarkersBody},
                           {"/map/update", "{}"}};

TEST(IcdRoutes, CheckTheTokenFirst) {
  Team team;
  const std::pair<std::string_view, std::string> wrong[] = {
      {"", ", got no such header"},
      {"Authorization: \r\n", ", got no such header"},
      {"Authorization: Bearer\r\n", ", got no bearer token"},
      {"Authorization: Bearer wrong\r\n", ""},
      {"Authorization: Bearer flux230{showroo\r\n", ""},
      {"Authorization: Bearer flux230{showroomm\r\n", ""},
      {"Authorization: Bearer FLUX230{SHOWROOM\r\n", ""},
      {"Authorization: flux230{showroom\r\n", ", got no bearer token"},
      {"Authorization: Basic flux230{showroom\r\n", ", got Basic"},
      {"Authorization: Bearer flux230{showroom the-posts-own-token\r\n", ""},
      {"X-Authorization: Bearer flux230{showroom\r\n", ", got no such header"},
  };
  for (const auto& [header, got] : wrong) {
    for (const icd::Uri uri : icd::kUris) {
      for (const std::string_view method : {"GET", "POST", "DELETE"}) {
        const auto reply = team.ask(request(method, icd::path_of(uri), header, "not even JSON"));
        ASSERT_TRUE(reply) << header;
        EXPECT_EQ(reply->status, 401) << header;
        EXPECT_EQ(reply->body, "\"Authorization: expected Bearer and the team's token" + got + "\"");
        EXPECT_EQ(reply->header("content-type"), "application/json");
        EXPECT_EQ(reply->header("access-control-allow-origin"), "*");
        EXPECT_FALSE(reply->headers.contains("www-authenticate"));  // ICD 4
      }
    }
  }
  EXPECT_EQ(team.served.on_loop([&] { return team.message_handler.refusals.size(); }),
            std::size(wrong) * std::size(icd::kUris) * 3);
}

TEST(IcdRoutes, TellInWhichOrderUploadsBeganAndEnded) {
  Team team;
  const std::string markers = authorized("POST", "/markers/update", kJsonType, kMarkersBody);
  RawClient slow(team.served.port());
  slow.send(markers.substr(0, markers.size() - 1));
  ASSERT_TRUE(team.ask(authorized("POST", "/state/update", kJsonType, kStateBody)));
  ASSERT_TRUE(team.ask(markers));
  slow.send(markers.substr(markers.size() - 1));
  ASSERT_TRUE(slow.reply());
  const auto senders = team.served.on_loop([&] { return team.message_handler.senders; });
  ASSERT_EQ(senders.size(), 3u);
  EXPECT_EQ(senders[0].overlaps, 0u) << "the other upload is to another URI";
  EXPECT_EQ(senders[1].overlaps, senders[2].began);
  EXPECT_LT(senders[2].began, senders[1].began);
  EXPECT_LT(senders[1].ended, senders[2].ended);
  EXPECT_EQ(senders[2].overlaps, 0u) << "the other upload is over";
}

TEST(IcdRoutes, AcceptEachTokenWithBearerInAnyLetterCase) {
  Team team;
  for (const std::string_view scheme : {"Bearer", "bearer", "BEARER", "bEaReR"}) {
    for (const std::string_view token : {kToken, kOtherToken}) {
      const std::string header = "Authorization: " + std::string(scheme) + " " + std::string(token) + "\r\n";
      const auto reply =
          team.ask(request("POST", "/state/update", header + std::string(kJsonType), kStateBody));
      ASSERT_TRUE(reply);
      EXPECT_EQ(reply->status, 200) << header;
    }
  }
}

TEST(IcdRoutes, RejectAllClientsIfNoTokenIsSet) {
  Team team{IcdOptions{}};
  for (const std::string header : {"", "Authorization: Bearer \r\n", "Authorization: Bearer any\r\n"}) {
    const auto reply =
        team.ask(request("POST", "/state/update", header + std::string(kJsonType), kStateBody));
    ASSERT_TRUE(reply) << header;
    EXPECT_EQ(reply->status, 401) << header;
    EXPECT_EQ(reply->body, "\"Authorization: no token is set on this box yet\"");
  }
}

TEST(IcdRoutes, RequireNoTokenIfTheSettingSaysSo) {
  IcdOptions options;
  options.asks_token = false;
  Team team{options};
  EXPECT_EQ(team.ask(request("POST", "/state/update", kJsonType, kStateBody))->status, 200);
  EXPECT_EQ(team.ask(request("POST", "/state/update",
                             "Authorization: Bearer any\r\n" + std::string(kJsonType), kStateBody))
                ->status,
            200);
}

/// Pages of other origins if clients need no token.
TEST(IcdRoutes, RequireATokenFromAForeignPage) {
  IcdOptions options = Team::with_tokens();
  options.asks_token = false;
  options.origins = {"http://10.0.0.20:3000", "app://station"};
  Team team{options};
  const auto status = [&team](std::string_view host, std::string_view headers) {
    std::string text =
        request("POST", "/state/update", std::string(headers) + std::string(kJsonType), kStateBody);
    const auto at = text.find("Host: ") + 6;
    text.replace(at, text.find('\r', at) - at, host);
    const auto reply = team.ask(text);
    return reply ? std::pair(reply->status, reply->body) : std::pair(0, std::string());
  };
  const std::pair<int, std::string> taken(200, "null");
  const std::string token = "Authorization: Bearer " + std::string(kToken) + "\r\n";
  EXPECT_EQ(status("evil.example", ""), taken) << "not a page";
  for (const std::string origin : {"http://10.0.0.20:3000", "HTTP://10.0.0.20:3000", "app://station",
                                   "http://10.0.0.1:8000", "https://10.0.0.1:8000"}) {
    EXPECT_EQ(status("10.0.0.1:8000", "Origin: " + origin + "\r\n"), taken) << origin;
  }
  for (const std::string origin :
       {"http://evil.example", "null", "http://10.0.0.1", "http://10.0.0.1:8001", "http://10.0.0.2:8000",
        "http://10.0.0.20", "http://10.0.0.20:30000", "https://10.0.0.20:3000", "app://station.evil"}) {
    const auto [code, body] = status("10.0.0.1:8000", "Origin: " + origin + "\r\n");
    EXPECT_EQ(code, 403) << origin;
    EXPECT_EQ(body, R"("Origin: a page of \")" + origin +
                        R"(\" needs the team's token, or an entry in the setting team.origins")");
    EXPECT_EQ(status("10.0.0.1:8000", "Origin: " + origin + "\r\nAuthorization: Bearer wrong\r\n").first,
              403);
    EXPECT_EQ(status("10.0.0.1:8000", "Origin: " + origin + "\r\n" + token), taken) << origin;
  }
  for (const std::string origin : {"http://evil.example:8000", "http://10.0.0.20:3000"}) {
    const auto [code, body] = status("evil.example:8000", "Origin: " + origin + "\r\n");
    EXPECT_EQ(code, 403) << "a foreign name for the box";
    EXPECT_TRUE(body.starts_with("\"Host: expected the box's address")) << body;
    EXPECT_EQ(status("evil.example:8000", "Origin: " + origin + "\r\n" + token), taken);
  }
  EXPECT_EQ(status("adit.local:8000", "Origin: http://adit.local:8000\r\n"), taken);
  team.served.on_loop([&] {
    EXPECT_EQ(team.message_handler.refusals.front().second.setting, "team.origins") << "another origin";
    EXPECT_EQ(team.message_handler.refusals.back().second.setting, "") << "another Host";
  });
}

TEST(IcdRoutes, RejectOtherMethodsWithAnAllowHeader) {
  Team team;
  for (const icd::Uri uri : icd::kUris) {
    for (const std::string_view method : {"GET", "HEAD", "POST", "PUT", "DELETE", "PATCH", "get", "BREW"}) {
      const bool is_head = method == "HEAD";
      if (method == icd::method_of(uri) || (is_head && uri == icd::Uri::Status)) continue;
      RawClient client(team.served.port());
      client.send(authorized(method, icd::path_of(uri)));
      const auto reply = client.reply(std::chrono::seconds(10), is_head);
      ASSERT_TRUE(reply);
      EXPECT_EQ(reply->status, 405) << method << icd::path_of(uri);
      EXPECT_EQ(reply->header("allow"), uri == icd::Uri::Status ? "GET, HEAD, OPTIONS" : "POST, OPTIONS");
      EXPECT_TRUE(is_head || is_json_string(reply->body)) << reply->body;
      EXPECT_EQ(reply->header("access-control-allow-origin"), "*");
    }
  }
}

TEST(IcdRoutes, RejectAPostWithoutALength) {  // RFC 9110 15.5.12
  Team team;
  for (const Post& post : kPosts) {
    for (const std::string_view version :
         {"HTTP/1.1", "HTTP/1.0"}) {  // without a length, the connection's end is the body's end
      std::string text = authorized("POST", post.path, kJsonType) + std::string(post.body);
      text.replace(text.find("HTTP/1.1"), version.size(), version);
      const auto reply = team.ask(text);
      ASSERT_TRUE(reply) << post.path;
      EXPECT_EQ(reply->status, 411) << post.path << version;
      EXPECT_EQ(reply->body, "\"Content-Length: missing, and no body came in chunks\"");
    }
    EXPECT_EQ(
        team.ask(authorized("POST", post.path, std::string(kJsonType) + "Content-Length: 0\r\n"))->status,
        400);
  }
}

TEST(IcdRoutes, AnswerPreflightsWithoutAToken) {
  Team team;
  for (const icd::Uri uri : icd::kUris) {
    const auto reply = team.ask(request("OPTIONS", icd::path_of(uri),
                                        "Origin: http://base\r\nAccess-Control-Request-Method: POST\r\n"
                                        "Access-Control-Request-Headers: authorization, x-team\r\n"));
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 204);
    EXPECT_EQ(reply->body, "");
    EXPECT_EQ(reply->header("access-control-allow-origin"), "*");
    EXPECT_EQ(reply->header("access-control-allow-methods"),
              uri == icd::Uri::Status ? "GET, HEAD, OPTIONS" : "POST, OPTIONS");
    EXPECT_EQ(reply->header("access-control-allow-headers"), "authorization, x-team");
    EXPECT_FALSE(reply->header("access-control-max-age").empty());
    EXPECT_TRUE(team.served.on_loop([&] { return team.message_handler.refusals.empty(); }));
  }
}

TEST(IcdRoutes, TellOfMessagesWithoutATokenAndOfNoOtherRequests) {
  Team team;
  for (const char* path : {"/map/update", "/api/status"}) team.ask(request("GET", path));
  team.ask(request("OPTIONS", "/map/update"));
  team.ask(request("POST", "/elsewhere", {}, "1"));
  EXPECT_EQ(team.served.ended(CloseReason::NoToken), 0u);
  team.ask(request("POST", "/map/update", {}, "1"));
  team.ask(request("POST", "/map/update", "Authorization: Basic dGVhbTp4\r\n", "1"));
  EXPECT_EQ(team.served.ended(CloseReason::NoToken), 2u);
  EXPECT_EQ(team.served.ended(CloseReason::WrongToken), 0u);
  team.ask(request("GET", "/api/status", "Authorization: Bearer wrong\r\n"));
  EXPECT_EQ(team.served.ended(CloseReason::WrongToken), 1u);
}

/// Whether a page of another origin can read the answer and its Retry-After.
bool is_readable(const std::optional<Reply>& reply) {
  return reply && reply->header("access-control-allow-origin") == "*" &&
         reply->header("access-control-expose-headers") == "Age, Retry-After, Adit-Report, Adit-Reconciled";
}

TEST(IcdRoutes, LetPagesReadWhatAClientMayKnow) {
  Team team;
  const auto good = team.ask(authorized("POST", "/state/update", kJsonType, kStateBody));
  EXPECT_TRUE(is_readable(good) && good->status == 200);
  const auto nothing = team.ask(request("POST", "/map/updates", kJsonType, "{}"));
  EXPECT_TRUE(is_readable(nothing) && nothing->status == 404);
  const auto preflight =
      team.ask(request("OPTIONS", "/map/updates", "Access-Control-Request-Method: POST\r\n"));
  EXPECT_TRUE(is_readable(preflight) && preflight->status == 204);
  const std::string long_field = "X-Long: " + std::string(17'000, 'x') + "\r\n";
  const auto long_head = team.ask(request("POST", "/map/update?a=b", long_field));
  EXPECT_TRUE(is_readable(long_head) && long_head->status == 431);
  const auto bad_chunks = team.ask(
      authorized("POST", "/map/update", std::string(kJsonType) + "Transfer-Encoding: chunked\r\n") + "x\r\n");
  EXPECT_TRUE(is_readable(bad_chunks) && bad_chunks->status == 400);
}

TEST(IcdRoutes, LetNoPageReadTheApi) {
  Team team;
  for (const std::string& text :
       {request("GET", "/adit/nothing"), request("GET", "/adit/x", "Broken\r\n"),
        request("GET", "/other", "X-Long: " + std::string(17'000, 'x') + "\r\n"),
        request("OPTIONS", "/adit/run", "Access-Control-Request-Method: GET\r\n")}) {
    const auto reply = team.ask(text);
    ASSERT_TRUE(reply);
    EXPECT_GE(reply->status, 400);
    EXPECT_FALSE(reply->headers.contains("access-control-allow-origin")) << text;
  }
}

/// Whoever makes the answer: a rule of the server.
TEST(IcdRoutes, SayWhenToRetry) {
  Team team;
  for (const auto status : {icd::Status::TooManyRequests, icd::Status::ServiceUnavailable}) {
    team.served.on_loop([&] { team.message_handler.full = icd::Refusal{status, "full"}; });
    for (const auto& [path, body] :
         {std::pair("/map/update", grid_body(2, 2)), std::pair("/state/update", std::string(kStateBody)),
          std::pair("/markers/update", std::string(kMarkersBody))}) {
      const auto reply = team.ask(authorized("POST", path, kJsonType, body));
      ASSERT_TRUE(reply);
      EXPECT_EQ(reply->status, std::to_underlying(status)) << path;
      EXPECT_EQ(reply->header("retry-after"), "1") << path;
    }
  }
  team.served.on_loop([&] { team.front.routes->stop(); });
  EXPECT_EQ(team.ask(authorized("POST", "/state/update", kJsonType, kStateBody))->header("retry-after"), "1");
}

TEST(IcdRoutes, EchoNoInvalidHeaderNames) {
  Team team;
  for (const std::string& asked : {std::string("a\"b"), std::string("<script>"), std::string("a:b"),
                                   std::string(2000, 'a'), std::string()}) {
    const auto reply =
        team.ask(request("OPTIONS", "/map/update", "Access-Control-Request-Headers: " + asked + "\r\n"));
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->header("access-control-allow-headers"), "authorization, content-type, content-encoding");
  }
}

TEST(IcdRoutes, PassOtherPathsToTheOtherHandler) {
  Team team;
  for (const std::string_view path : {"/", "/api", "/api/status2", "/map", "/map/update/x", "/MAP/UPDATE",
                                      "//map/update", "/x/../map/update", "/index.html", "/%2e/map/update"}) {
    const auto reply = team.ask(authorized("POST", path, kJsonType, "{}"));
    ASSERT_TRUE(reply) << path;
    EXPECT_EQ(reply->status, 404) << path;
    EXPECT_TRUE(is_json_string(reply->body)) << path;
    EXPECT_TRUE(is_readable(reply)) << path;
  }
}

TEST(IcdRoutes, AcceptPathsWithASlashOrPercentEncoding) {
  Team team;
  for (const std::string_view path :
       {"/state/update", "/state/update/", "/state/update?x=1", "/%73tate/update"}) {
    EXPECT_EQ(team.ask(authorized("POST", path, kJsonType, kStateBody))->status, 200) << path;
  }
}

TEST(IcdRoutes, AcceptOnlyTheContentTypesOfTheIcd) {
  Team team;
  struct Case {
    std::string_view path, type;
    int status;  // for an invalid body
  };
  const Case cases[] = {
      {"/state/update", "application/json", 400},
      {"/state/update", "application/json; charset=utf-8", 400},
      {"/state/update", "APPLICATION/JSON;charset=UTF-8", 400},
      {"/state/update", "application/cbor", 400},
      {"/markers/update", "application/cbor", 400},
      {"/map/update", "application/cbor", 400},
      {"/api/artifact_reports", "application/json", 400},
      {"/api/artifact_reports", "application/cbor", 422},  // ICD 4
      {"/state/update", "", 422},
      {"/state/update", "text/json", 422},
      {"/state/update", "application/jsonx", 422},
      {"/map/update", "multipart/form-data", 422},
      {"/map/update", "application/x-www-form-urlencoded", 422},
  };
  for (const Case& c : cases) {
    const std::string header =
        c.type.empty() ? std::string() : "Content-Type: " + std::string(c.type) + "\r\n";
    const auto reply = team.ask(authorized("POST", c.path, header, "\xff\xff"));
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, c.status) << c.path << c.type;
    EXPECT_TRUE(is_json_string(reply->body)) << reply->body;
    EXPECT_EQ(reply->body.starts_with("\"Content-Type: "), c.status == 422) << reply->body;
  }
}

TEST(IcdRoutes, NameAnUnknownContentEncoding) {
  Team team;
  for (const Post& post : kPosts) {
    const auto reply = team.ask(
        authorized("POST", post.path, std::string(kJsonType) + "Content-Encoding: br\r\n", post.body));
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 422);
    EXPECT_EQ(reply->body, "\"Content-Encoding: expected gzip, deflate or no such header, got \\\"br\\\"\"");
  }
}

TEST(IcdRoutes, RejectATooLargeBodyByItsLength) {
  Team team;
  for (const Post& post : kPosts) {
    RawClient client(team.served.port());
    client.send(authorized("POST", post.path, std::string(kJsonType) + "Content-Length: 99999999999\r\n"));
    const auto reply = client.reply();
    ASSERT_TRUE(reply) << post.path;
    EXPECT_EQ(reply->status, 413) << post.path;
    EXPECT_TRUE(reply->body.starts_with("\"Content-Length: expected at most ")) << reply->body;
    EXPECT_EQ(reply->header("access-control-allow-origin"), "*");
  }
}

}  // namespace
}  // namespace adit::intake
