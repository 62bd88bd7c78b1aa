// The rules of shares_test.cpp with real sockets.
#include <gtest/gtest.h>

#include "intake/raw_client.hpp"
#include "intake/scripted_handler.hpp"
#include "intake/served.hpp"

namespace adit::intake {
namespace {

using Clients = std::vector<std::unique_ptr<RawClient>>;

constexpr std::string_view kToken = "Authorization: Bearer x\r\n";

/// A request in the middle of its body.
std::string unfinished_request(std::string_view headers = {}) {
  return request("POST", "/echo", std::string(headers) + "Content-Length: 4000\r\n") + "x";
}

class ServerRoom : public testing::Test {
 protected:
  ServerRoom() { handler.asks_token = true; }

  RawClient& connect(Clients& clients, const std::string& source, std::string_view bytes) {
    clients.push_back(std::make_unique<RawClient>(served.port(), source));
    clients.back()->send(bytes);
    return *clients.back();
  }
  bool has_authenticated(std::size_t count) {
    return served.eventually([&] {
      return served.server().connections() - served.server().unauthenticated_connections() == count;
    });
  }

  ScriptedHandler handler;
  Served served{handler,
                {.address = "127.0.0.1", .interface = {}, .connections = 8, .connections_per_address = 3}};
};

class DefaultServerRoom : public ServerRoom {
 protected:
  Served served{handler};
};

TEST_F(DefaultServerRoom, IsReservedForAuthenticatedClients) {
  RawClient known(served.port());
  known.send(request("POST", "/echo", kToken, "1"));
  ASSERT_EQ(known.reply()->status, 200);
  Clients held;
  for (int i = 0; i < 100; ++i) {
    held.push_back(std::make_unique<RawClient>(served.port(), "127.0.1." + std::to_string(1 + i % 4)));
    held.back()->send(unfinished_request());
    if (i % 10 != 9) continue;
    RawClient one(served.port());
    one.send(request("POST", "/echo", kToken, "2"));
    ASSERT_TRUE(one.reply()) << i;
    known.send(request("POST", "/echo", kToken, "3"));
    ASSERT_TRUE(known.reply()) << i;
  }
  EXPECT_TRUE(served.eventually([&] { return served.server().unauthenticated_connections() <= 32; }));
  EXPECT_GE(served.ended(CloseReason::GaveWay), 60u);
  const auto told = held.front()->reply();
  ASSERT_TRUE(told);
  EXPECT_EQ(told->status, 503);
  EXPECT_EQ(told->header("retry-after"), "1");
  EXPECT_TRUE(told->body.starts_with('"')) << told->body;
}

TEST_F(ServerRoom, IsLimitedForRequestsOfOneAddress) {
  Clients busy;
  for (int i = 0; i < 3; ++i) connect(busy, "127.0.0.2", request("GET", "/later", kToken));
  ASSERT_TRUE(has_authenticated(3));
  RawClient more(served.port(), "127.0.0.2");
  more.send(request("POST", "/echo", kToken, std::string(2000, 'x')));
  const auto told = more.reply();
  ASSERT_TRUE(told);
  EXPECT_EQ(told->status, 503);
  EXPECT_EQ(told->header("retry-after"), "1");
  EXPECT_TRUE(told->body.starts_with("\"too many requests")) << told->body;
  EXPECT_TRUE(more.closes());
  EXPECT_EQ(served.ended(CloseReason::NoRoom), 1u);
  RawClient other(served.port(), "127.0.0.3");
  other.send(request("POST", "/echo", kToken, "1"));
  EXPECT_EQ(other.reply()->status, 200);
}

TEST_F(ServerRoom, ComesFromAnIdleConnectionOfTheAddress) {
  Clients idle;
  for (int i = 0; i < 3; ++i)
    ASSERT_TRUE(connect(idle, "127.0.0.2", request("POST", "/echo", kToken, "1")).reply());
  RawClient more(served.port(), "127.0.0.2");
  more.send(request("POST", "/echo", kToken, "1"));
  EXPECT_EQ(more.reply()->status, 200);
  EXPECT_TRUE(idle[0]->closes());
  idle[1]->send(request("POST", "/echo", kToken, "1"));
  EXPECT_EQ(idle[1]->reply()->status, 200);
  EXPECT_EQ(served.ended(CloseReason::Idle), 1u);
}

TEST_F(ServerRoom, IsNotHeldByDisconnectedClients) {
  std::promise<void> all_there;
  served.loop().post([&] { all_there.get_future().wait(); });
  for (int i = 0; i < 3; ++i) RawClient(served.port(), "127.0.0.2").send(request("GET", "/later", kToken));
  RawClient stays(served.port(), "127.0.0.2");
  stays.send(request("POST", "/echo", kToken, "1"));
  all_there.set_value();
  EXPECT_EQ(stays.reply()->status, 200);
}

TEST_F(ServerRoom, IsSharedByAddressesIfAllAreAuthenticated) {
  handler.asks_token = false;
  Clients greedy;
  for (int i = 0; i < 3; ++i) connect(greedy, "127.0.0.2", unfinished_request());
  for (int i = 0; i < 3; ++i) connect(greedy, "127.0.0.3", unfinished_request());
  ASSERT_TRUE(has_authenticated(6));
  RawClient other(served.port(), "127.0.0.4");
  other.send(request("POST", "/echo", {}, "1"));
  ASSERT_EQ(other.reply()->status, 200);
  EXPECT_EQ(served.ended(CloseReason::GaveWay), 1u);
}

TEST_F(ServerRoom, GoesToTheLatestUnauthenticatedClients) {
  Clients strangers;
  for (int i = 0; i < 3; ++i) {
    connect(strangers, "127.0.0." + std::to_string(2 + i), unfinished_request());
    ASSERT_TRUE(served.eventually([&] { return handler.body_bytes == static_cast<std::size_t>(i + 1); }));
  }
  EXPECT_EQ(strangers[0]->reply()->status, 503);
  EXPECT_TRUE(strangers[0]->closes());
  EXPECT_TRUE(served.eventually([&] { return served.server().connections() == 2; }));
}

}  // namespace
}  // namespace adit::intake
