#include <gtest/gtest.h>
#include <sys/socket.h>

#include <atomic>
#include <thread>

#include "rehearsal/robots/client.hpp"
#include "server.hpp"

namespace adit::robots {
namespace {

using namespace std::chrono_literals;

/// Reads one request's head (the tests' requests have no body); empty where the client has gone.
std::string read_head(int connection) {
  std::string head;
  char c = 0;
  while (!head.ends_with("\r\n\r\n") && recv(connection, &c, 1, 0) == 1) head += c;
  return head;
}

void answer(int connection, const std::string& reply) {
  (void)send(connection, reply.data(), reply.size(), MSG_NOSIGNAL);
}

constexpr const char* kNull =
    "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: 4\r\n\r\nnull";

const HttpRequest kRequest{
    .method = "GET", .target = "/api/status", .fields = {{"Authorization", "Bearer t"}}, .body = {}};

TEST(Connection, SendsTheRequestAndReadsTheReply) {
  std::string head;
  const Server server([&](int connection) {
    head = read_head(connection);
    answer(connection, kNull);
  });
  Connection connection(server.address(), {});
  const auto reply = connection.exchange(kRequest, 20s);
  ASSERT_TRUE(reply) << reply.error();
  EXPECT_EQ(reply->status, 200);
  EXPECT_EQ(reply->body, "null");
  EXPECT_TRUE(head.starts_with("GET /api/status HTTP/1.1\r\n"));
  EXPECT_NE(head.find("Authorization: Bearer t\r\n"), std::string::npos);
  EXPECT_NE(head.find("Host: 127.0.0.1:"), std::string::npos);
}

TEST(Connection, IsKeptBetweenRequests) {
  std::atomic<int> connections = 0;
  const Server server([&](int connection) {
    ++connections;
    while (!read_head(connection).empty()) answer(connection, kNull);
  });
  Connection connection(server.address(), {});
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(connection.exchange(kRequest, 20s));
  EXPECT_EQ(connections, 1);
}

/// As the mapping server does after a 4xx.
TEST(Connection, ReconnectsIfTheServerClosedDespiteKeepAlive) {
  const Server server([](int connection) {
    read_head(connection);
    answer(connection, kNull);
  });
  Connection connection(server.address(), {});
  for (int i = 0; i < 5; ++i) {
    const auto reply = connection.exchange(kRequest, 20s);
    ASSERT_TRUE(reply) << reply.error();
  }
}

TEST(Connection, DoesNotResendARequestToBeSentOnce) {
  std::atomic<int> requests = 0;
  const Server server([&](int connection) {
    if (!read_head(connection).empty()) ++requests;
    answer(connection, kNull);
    if (!read_head(connection).empty()) ++requests;  // and closes without an answer
  });
  Connection connection(server.address(), {});
  ASSERT_TRUE(connection.exchange(kRequest, 20s));
  EXPECT_FALSE(connection.exchange(kRequest, 20s, /*send_once=*/true));
  EXPECT_EQ(requests, 2);
}

TEST(Connection, GivesUpAtTheDeadline) {
  const Server server([](int connection) {
    read_head(connection);
    read_head(connection);  // until the client goes
  });
  Connection connection(server.address(), {});
  const auto reply = connection.exchange(kRequest, 200ms);
  ASSERT_FALSE(reply);
  EXPECT_EQ(reply.error(), "no answer within 200 ms");
}

TEST(Connection, StopsAtOnceWhenAsked) {
  const Server server([](int connection) {
    read_head(connection);
    read_head(connection);
  });
  std::stop_source stop;
  Connection connection(server.address(), stop.get_token());
  const std::jthread stopper([&] {
    std::this_thread::sleep_for(100ms);
    stop.request_stop();
  });
  const auto start = std::chrono::steady_clock::now();
  const auto reply = connection.exchange(kRequest, 60s);
  ASSERT_FALSE(reply);
  EXPECT_EQ(reply.error(), "stopped before the answer arrived");
  EXPECT_LT(std::chrono::steady_clock::now() - start, 30s);
}

TEST(Connection, TellsWhyThereIsNoAnswer) {
  const Server garbage([](int connection) {
    read_head(connection);
    answer(connection, "SSH-2.0-OpenSSH\r\n\r\n");
  });
  EXPECT_FALSE(Connection(garbage.address(), {}).exchange(kRequest, 20s));
  const Server large([](int connection) {
    read_head(connection);
    answer(connection, "HTTP/1.1 200 OK\r\nContent-Length: 999999999\r\n\r\n");
  });
  EXPECT_FALSE(Connection(large.address(), {}).exchange(kRequest, 20s));
  const auto nobody = Connection({.host = "127.0.0.1", .port = 1}, {}).exchange(kRequest, 20s);
  ASSERT_FALSE(nobody);
  EXPECT_EQ(nobody.error(), "Connection refused");
}

}  // namespace
}  // namespace adit::robots
