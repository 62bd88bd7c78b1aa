#include "cli/http_get.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/server.hpp"

namespace adit::cli {
namespace {

using std::chrono::milliseconds;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr milliseconds kPatience{2000};

std::string body_of(const std::string& answer) {
  const Server server(answer);
  const auto body = http_get(server.address(), "/adit/run", kPatience);
  return body ? *body : "error: " + body.error();
}

TEST(HttpGet, GivesTheBody) {
  EXPECT_EQ(body_of(Server::ok("{\"now\": 1}")), "{\"now\": 1}");
}

TEST(HttpGet, AsksForTheTargetAndShowsNoToken) {
  std::string request;
  {
    const Server server(Server::ok("{}"));
    ASSERT_TRUE(http_get(server.address(), "/adit/run", kPatience).has_value());
    request = server.request();
  }
  EXPECT_THAT(request, StartsWith("GET /adit/run HTTP/1.1\r\nHost: 127.0.0.1:"));
  EXPECT_THAT(request, Not(HasSubstr("Authorization")));
}

TEST(HttpGet, TakesABodyInChunksAndOneThatEndsWithTheConnection) {
  EXPECT_EQ(body_of("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n2\r\nde\r\n0\r\n\r\n"),
            "abcde");
  EXPECT_EQ(body_of("HTTP/1.1 200 OK\r\n\r\nto the end"), "to the end");
  EXPECT_EQ(body_of(Server::ok("")), "");
}

TEST(HttpGet, TakesALargeBody) {
  const std::string body(3u << 20, 'x');
  EXPECT_EQ(body_of(Server::ok(body)).size(), body.size());
}

TEST(HttpGet, SaysWhyThereIsNoBody) {
  EXPECT_THAT(body_of("HTTP/1.1 404 Not Found\r\nContent-Length: 2\r\n\r\n{}"), HasSubstr("it answered 404"));
  EXPECT_THAT(body_of("HTTP/1.1 200 OK\r\nContent-Length: 9\r\n\r\n{}"),
              HasSubstr("in the middle of its answer"));
  EXPECT_THAT(body_of(""), HasSubstr("in the middle of its answer"));
  EXPECT_THAT(body_of("SSH-2.0-OpenSSH_9.2\r\n"), HasSubstr("no HTTP"));
  EXPECT_THAT(body_of("HTTP/1.1 200 OK\r\nContent-Length: 99999999999\r\n\r\n"), HasSubstr("too long"));
}

TEST(HttpGet, NamesTheAddressThatNobodyListensAt) {
  settings::Address address;
  {
    address = Server("").address();
  }
  const auto body = http_get(address, "/", kPatience);
  ASSERT_FALSE(body.has_value());
  EXPECT_EQ(body.error(),
            "Adit at 127.0.0.1:" + std::to_string(address.port) + " cannot be asked: Connection refused");
}

TEST(HttpGet, GivesUpOnAServerThatSaysNothing) {
  for (const std::string answer : {"", "HTTP/1.1 200 OK\r\nContent-Length: 9\r\n\r\n{}"}) {
    const Server server(answer, true);
    const auto began = std::chrono::steady_clock::now();
    const auto body = http_get(server.address(), "/", milliseconds(100));
    ASSERT_FALSE(body.has_value());
    EXPECT_THAT(body.error(), HasSubstr("timed out"));
    EXPECT_LT(std::chrono::steady_clock::now() - began, milliseconds(1500));
  }
}

}  // namespace
}  // namespace adit::cli
