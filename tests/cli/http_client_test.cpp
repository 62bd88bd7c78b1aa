#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/ask.hpp"
#include "cli/server.hpp"

namespace adit::cli {
namespace {

using std::chrono::milliseconds;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

constexpr milliseconds kPatience{20000};

std::expected<HttpReply, NoReply> ask(const settings::Address& address, uplink::Request request,
                                      milliseconds within = kPatience) {
  return http_ask(address, *icd::BearerToken::parse("secret"), std::move(request), within);
}

std::string body_of(const std::string& answer) {
  const Server server(answer);
  const auto reply = ask(server.address(), get_request("/adit/run"));
  return reply ? reply->body : "error: " + reply.error().sentence;
}

TEST(HttpClient, GivesTheBody) {
  EXPECT_EQ(body_of(Server::ok("{\"now\": 1}")), "{\"now\": 1}");
}

std::string request_for(uplink::Request request) {
  const Server server(Server::ok("{}"));
  EXPECT_TRUE(ask(server.address(), std::move(request)).has_value());
  return server.request();
}

TEST(HttpClient, RequestsTheTargetWithItsToken) {
  const std::string request = request_for(get_request("/adit/run"));
  EXPECT_THAT(request, StartsWith("GET /adit/run HTTP/1.1\r\nHost: 127.0.0.1:"));
  EXPECT_THAT(request, HasSubstr("\r\nAuthorization: Bearer secret\r\n"));
}

TEST(HttpClient, PostsABodyOrNone) {
  Post post{.target = "/adit/runs", .check = "adit reports"};
  EXPECT_THAT(
      request_for(post_request(post)),
      AllOf(StartsWith("POST /adit/runs HTTP/1.1\r\n"), HasSubstr("\r\nContent-Type: application/json\r\n"),
            HasSubstr("\r\nContent-Length: 0\r\n"), EndsWith("\r\n\r\n")));
  post.body = "{}";
  EXPECT_THAT(request_for(post_request(post)),
              AllOf(HasSubstr("\r\nContent-Length: 2\r\n"), EndsWith("\r\n\r\n{}")));
}

TEST(HttpClient, GivesStatusAndBodyOfAnError) {
  const Server server(Server::reply("409 Conflict", "\"no\""));
  const auto reply = ask(server.address(), get_request("/"));
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->status, 409u);
  EXPECT_EQ(reply->body, "\"no\"");
}

TEST(HttpClient, ReadsChunkedBodiesAndBodiesUntilClose) {
  EXPECT_EQ(body_of("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n2\r\nde\r\n0\r\n\r\n"),
            "abcde");
  EXPECT_EQ(body_of("HTTP/1.1 200 OK\r\n\r\nto the end"), "to the end");
  EXPECT_EQ(body_of(Server::ok("")), "");
}

TEST(HttpClient, ReadsALargeBody) {
  const std::string body(3u << 20, 'x');
  EXPECT_EQ(body_of(Server::ok(body)).size(), body.size());
}

TEST(HttpClient, TellsWhyThereIsNoBody) {
  EXPECT_THAT(body_of("HTTP/1.1 200 OK\r\nContent-Length: 9\r\n\r\n{}"),
              HasSubstr("in the middle of its answer"));
  EXPECT_THAT(body_of(""), HasSubstr("did not answer"));
  EXPECT_THAT(body_of("SSH-2.0-OpenSSH_9.2\r\n"), HasSubstr("not HTTP"));
  EXPECT_THAT(body_of("HTTP/1.1 200 OK\r\nContent-Length: 99999999999\r\n\r\n"), HasSubstr("too long"));
  EXPECT_THAT(body_of("HTTP/1.1 200 OK\r\nContent-Length: 8388609\r\n\r\n"), HasSubstr("too long"));
}

TEST(HttpClient, NamesAnUnreachableAddress) {
  settings::Address address;
  {
    address = Server("").address();
  }
  const auto reply = ask(address, get_request("/"));
  ASSERT_FALSE(reply.has_value());
  EXPECT_FALSE(reply.error().sent);
  EXPECT_EQ(reply.error().sentence,
            "cannot reach Adit at 127.0.0.1:" + std::to_string(address.port) + ": Connection refused");
}

TEST(HttpClient, TimesOutOnASilentServer) {
  for (const std::string answer : {"", "HTTP/1.1 200 OK\r\nContent-Length: 9\r\n\r\n{}"}) {
    const Server server(answer, true);
    const auto reply = ask(server.address(), get_request("/"), milliseconds(400));
    ASSERT_FALSE(reply.has_value());
    EXPECT_TRUE(reply.error().sent);
    EXPECT_THAT(reply.error().sentence, HasSubstr("timed out"));
  }
}

}  // namespace
}  // namespace adit::cli
