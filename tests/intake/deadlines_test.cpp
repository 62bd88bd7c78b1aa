#include <gtest/gtest.h>

#include "intake/raw_client.hpp"
#include "intake/scripted_handler.hpp"
#include "intake/served.hpp"
#include "loop/simulated_time.hpp"

namespace adit::intake {
namespace {

using namespace std::chrono_literals;

const Listen kHere{.address = "127.0.0.1", .interface = {}};

class Deadlines : public testing::Test {
 protected:
  explicit Deadlines(bool asks_token = false) {
    handler.asks_token = asks_token;
    EXPECT_TRUE(served.eventually([&] { return served.server().connections() == 1; }));
  }

  /// Advances time and lets the server act, after it has read all that the client sent.
  void pass(loop::Duration length) {
    settle();
    time.pass(length);
    settle();
  }
  /// More turns than a few connections need.
  void settle() {
    for (int turns = 0; turns < 20; ++turns) served.on_loop([] {});
  }
  /// Sends single bytes and passes time after each.
  void drip(std::string_view text, loop::Duration every) {
    for (const char byte : text) {
      EXPECT_TRUE(client.send({&byte, 1}));
      pass(every);
    }
  }
  bool is_open() { return !client.rest(0ms); }
  /// Status of the next answer; 0: none.
  int status() {
    const auto reply = client.reply();
    return reply ? reply->status : 0;
  }

  loop::SimulatedTime time;
  ScriptedHandler handler;
  Served served{handler, kHere};
  RawClient client{served.port()};
};

class UnauthenticatedDeadlines : public Deadlines {
 protected:
  UnauthenticatedDeadlines() : Deadlines(true) {}
};

TEST_F(Deadlines, CloseASilentClient) {
  pass(kHere.unauthenticated_within - 1ms);
  EXPECT_TRUE(is_open());
  pass(1ms);
  EXPECT_TRUE(client.closes());
  EXPECT_EQ(served.ended(CloseReason::Slow), 1u);
}

TEST_F(Deadlines, CloseAClientThatDripsItsHeaders) {
  drip("GET /echo", kHere.unauthenticated_within / 10);
  EXPECT_TRUE(is_open());
  drip(" ", kHere.unauthenticated_within / 10);
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 408);
  EXPECT_EQ(reply->body, "\"the head of the request took too long\"");
  EXPECT_TRUE(client.closes());
}

TEST_F(Deadlines, CloseAClientThatDripsItsSecondHead) {
  client.send(request("GET", "/echo"));
  ASSERT_TRUE(client.reply());
  drip("GET /echo", kHere.rate_over / 10);
  EXPECT_TRUE(is_open());
  drip(" ", kHere.rate_over / 10);
  EXPECT_TRUE(client.closes());
}

TEST_F(Deadlines, CloseAClientThatStopsInItsBody) {
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 100\r\n\r\nbegun");
  pass(kHere.rate_over / 2);
  EXPECT_TRUE(is_open());
  pass(kHere.rate_over / 2);
  EXPECT_EQ(status(), 408);
  EXPECT_TRUE(client.closes());
  EXPECT_TRUE(served.eventually([&] { return handler.gone == 1 && handler.exchanges == 0; }));
}

TEST_F(Deadlines, AllowASteadyBody) {
  const std::string piece(2000, 'x');  // 2 kB/s; the limit is 1 kB/s
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 60000\r\n\r\n");
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(client.send(piece));
    pass(1s);
  }
  EXPECT_EQ(status(), 200);
}

TEST_F(Deadlines, CloseAClientThatDripsItsBody) {
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 100000\r\n\r\n");
  drip("xxx", kHere.rate_over / 4);
  EXPECT_TRUE(is_open());
  drip("x", kHere.rate_over / 4);
  EXPECT_EQ(status(), 408);
}

TEST_F(UnauthenticatedDeadlines, CloseAClientThatDripsItsBody) {
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 100\r\n\r\n");
  drip("xxxx", kHere.unauthenticated_within / 5);
  EXPECT_TRUE(is_open());
  drip("x", kHere.unauthenticated_within / 5);
  EXPECT_EQ(status(), 408);
}

TEST_F(UnauthenticatedDeadlines, EndWithAToken) {
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nAuthorization: Bearer x\r\nContent-Length: 7\r\n\r\n");
  drip("xxxxxxx", kHere.unauthenticated_within / 5);
  EXPECT_EQ(status(), 200);
}

/// The answer exceeds the kernel's buffers, and reading it takes longer than the idle timeout.
TEST_F(Deadlines, AllowASteadyReader) {
  const std::string answer(12u << 20, 'x');
  client.send(request("GET", "/later"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  served.on_loop([&] { handler.responders[0]->answer({.body = answer, .headers = {}}); });
  loop::Duration took{};
  const auto read = client.read_slowly(800'000, answer.size(), [&] { pass(5s), took += 5s; });
  EXPECT_EQ(read, answer.size());
  EXPECT_GT(took, kHere.idle);
  EXPECT_EQ(served.ended(CloseReason::Slow), 0u);
}

TEST_F(Deadlines, CloseAClientThatStopsReading) {
  client.send(request("GET", "/later"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  served.on_loop(
      [&] { handler.responders[0]->answer({.body = std::string(16u << 20, 'x'), .headers = {}}); });
  const auto connections = [&] { return served.on_loop([&] { return served.server().connections(); }); };
  for (int halves = 0; halves < 6 && connections() != 0; ++halves) pass(kHere.rate_over / 2);
  EXPECT_EQ(connections(), 0u);
  EXPECT_EQ(served.ended(CloseReason::Slow), 1u);
}

TEST_F(Deadlines, PauseWhileTheGatewayHoldsTheBodyBack) {
  client.send("POST /held HTTP/1.1\r\nHost: adit\r\nContent-Length: 10\r\n\r\n01234");
  ASSERT_TRUE(served.eventually([&] { return handler.flows.size() == 1; }));
  pass(2 * kHere.idle);
  client.send("56789");
  served.on_loop([&] { handler.flows[0]->resume(); });
  ASSERT_TRUE(served.eventually([&] { return handler.flows.size() == 2; }));
  served.on_loop([&] { handler.flows[1]->resume(); });
  EXPECT_EQ(status(), 200);
}

TEST_F(Deadlines, ContinueOnceTheBodyMayFlow) {
  client.send("POST /held HTTP/1.1\r\nHost: adit\r\nContent-Length: 10\r\n\r\n01234");
  ASSERT_TRUE(served.eventually([&] { return handler.flows.size() == 1; }));
  served.on_loop([&] { handler.flows[0]->resume(); });
  for (int halves = 0; halves < 2; ++halves) pass(kHere.rate_over / 2);
  EXPECT_EQ(status(), 408);
}

TEST_F(Deadlines, PauseWhileTheAnswerIsPending) {
  client.send(request("GET", "/later"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  pass(2 * kHere.idle);
  served.on_loop([&] { handler.responders[0]->answer({.body = "1", .headers = {}}); });
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->body, "1");
}

TEST_F(Deadlines, CloseAnIdleConnection) {
  client.send(request("GET", "/echo"));
  ASSERT_TRUE(client.reply());
  pass(kHere.idle - 1ms);
  EXPECT_TRUE(is_open());
  pass(1ms);
  EXPECT_EQ(client.rest(), "");
}

TEST_F(Deadlines, RejectAMissingSmallBodyAfterASecond) {
  client.send("POST /refuse HTTP/1.1\r\nHost: adit\r\nContent-Length: 500\r\n\r\n");
  pass(1s - 1ms);
  EXPECT_FALSE(client.reply(0ms));
  pass(1ms);
  EXPECT_EQ(status(), 401);
}

TEST(RealDeadlines, CloseASilentClient) {
  ScriptedHandler handler;
  Listen soon = kHere;
  soon.unauthenticated_within = 50ms;
  const Served served(handler, soon);
  EXPECT_TRUE(RawClient(served.port()).closes());
}

}  // namespace
}  // namespace adit::intake
