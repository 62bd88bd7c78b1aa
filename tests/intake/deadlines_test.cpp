#include <gtest/gtest.h>

#include "intake/raw_client.hpp"
#include "intake/scripted_handler.hpp"
#include "intake/served.hpp"

namespace adit::intake {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// Those that a test is about are near, and the others are far away.
class Deadlines : public testing::Test {
 protected:
  struct Near {
    milliseconds headers_within{60000}, body_silence{60000}, idle{60000};
  };
  explicit Deadlines(const Near& near)
      : served(handler, {.address = "127.0.0.1",
                         .interface = {},
                         .headers_within = near.headers_within,
                         .body_silence = near.body_silence,
                         .idle = near.idle}) {}

  ScriptedHandler handler;
  Served served;
  Clock::time_point started = Clock::now();
  RawClient client{served.port()};

  milliseconds passed() const { return std::chrono::duration_cast<milliseconds>(Clock::now() - started); }

  /// Sends `text` a byte every 50 ms from a thread of its own.
  std::thread drip(RawClient& dripper, std::string text) {
    return std::thread([&dripper, text] {
      for (const char byte : text) {
        if (!dripper.send({&byte, 1})) return;
        std::this_thread::sleep_for(milliseconds(50));
      }
    });
  }
};

class HeadDeadlines : public Deadlines {
 protected:
  HeadDeadlines() : Deadlines({.headers_within = milliseconds(500)}) {}
};
class BodyDeadlines : public Deadlines {
 protected:
  BodyDeadlines() : Deadlines({.body_silence = milliseconds(1000)}) {}
};
class IdleDeadlines : public Deadlines {
 protected:
  IdleDeadlines() : Deadlines({.headers_within = milliseconds(500), .idle = milliseconds(600)}) {}
};

TEST_F(HeadDeadlines, CloseAClientThatSaysNothing) {
  EXPECT_TRUE(client.closes());
  EXPECT_GE(passed(), milliseconds(495));
}

TEST_F(HeadDeadlines, CloseAClientThatDripsItsHeaders) {
  std::thread dripping = drip(client, request("GET", "/echo", "X-Long: " + std::string(60, 'x') + "\r\n"));
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 408);
  EXPECT_EQ(reply->body, "\"the head of the request took too long\"");
  dripping.join();
  EXPECT_TRUE(client.closes());
}

TEST_F(IdleDeadlines, CloseAClientThatDripsTheHeadersOfItsSecondRequest) {
  client.send(request("GET", "/echo"));
  ASSERT_TRUE(client.reply());
  std::thread dripping = drip(client, "GET /" + std::string(400, 'x'));  // for longer than it waits
  EXPECT_TRUE(client.closes());
  dripping.join();
}

TEST_F(BodyDeadlines, CloseAClientThatStopsInTheMiddleOfItsBody) {
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 100\r\n\r\nbegun");
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 408);
  EXPECT_TRUE(client.closes());
  EXPECT_TRUE(served.eventually([&] { return handler.gone == 1 && handler.exchanges == 0; }));
}

TEST_F(BodyDeadlines, LetABodyThatKeepsComingTakeItsTime) {
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 24\r\n\r\n");
  drip(client, "0123456789ab0123456789ab").join();
  EXPECT_GE(passed(), milliseconds(1000));
  EXPECT_EQ(client.reply()->body, "POST /echo  127.0.0.1 0123456789ab0123456789ab");
}

TEST_F(BodyDeadlines, DoNotRunWhileTheGatewayHoldsTheBodyBack) {
  client.send("POST /held HTTP/1.1\r\nHost: adit\r\nContent-Length: 10\r\n\r\n01234");
  ASSERT_TRUE(served.eventually([&] { return handler.flows.size() == 1; }));
  std::this_thread::sleep_for(milliseconds(1200));
  client.send("56789");
  served.on_loop([&] { handler.flows[0]->resume(); });
  ASSERT_TRUE(served.eventually([&] { return handler.flows.size() == 2; }));
  served.on_loop([&] { handler.flows[1]->resume(); });
  EXPECT_EQ(client.reply()->status, 200);
}

TEST_F(BodyDeadlines, RunAgainOnceTheBodyMayFlow) {
  client.send("POST /held HTTP/1.1\r\nHost: adit\r\nContent-Length: 10\r\n\r\n01234");
  ASSERT_TRUE(served.eventually([&] { return handler.flows.size() == 1; }));
  served.on_loop([&] { handler.flows[0]->resume(); });
  EXPECT_EQ(client.reply()->status, 408);
}

TEST_F(IdleDeadlines, DoNotRunWhileTheAnswerIsAwaited) {
  client.send(request("GET", "/later"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  std::this_thread::sleep_for(milliseconds(900));
  served.on_loop([&] { handler.responders[0]->answer({.body = "1", .headers = {}}); });
  EXPECT_EQ(client.reply()->body, "1");
}

TEST_F(IdleDeadlines, CloseAConnection) {
  client.send(request("GET", "/echo"));
  ASSERT_TRUE(client.reply());
  EXPECT_EQ(client.rest(), "");
  EXPECT_GE(passed(), milliseconds(595));
}

TEST_F(IdleDeadlines, CloseAClientThatDoesNotReadItsAnswer) {
  client.send(request("GET", "/later"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  served.on_loop(
      [&] { handler.responders[0]->answer({.body = std::string(64u << 20, 'x'), .headers = {}}); });
  EXPECT_TRUE(served.eventually([&] { return served.server().connections() == 0; }));
}

TEST_F(HeadDeadlines, OfSomeLeaveOthersServed) {
  std::vector<std::unique_ptr<RawClient>> slow;
  for (int i = 0; i < 10; ++i) {
    slow.push_back(std::make_unique<RawClient>(served.port()));
    slow.back()->send("GET /echo HTT");
  }
  for (int i = 0; i < 10; ++i) {
    client.send(request("POST", "/echo", {}, "fine"));
    EXPECT_EQ(client.reply()->status, 200);
    std::this_thread::sleep_for(milliseconds(50));
  }
  for (auto& each : slow) EXPECT_TRUE(each->closes());
}

}  // namespace
}  // namespace adit::intake
