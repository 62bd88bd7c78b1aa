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
    milliseconds stranger_within{60000}, rate_over{60000}, idle{60000};
    bool asks_token = false;
  };
  explicit Deadlines(const Near& near)
      : served(handler, {.address = "127.0.0.1",
                         .interface = {},
                         .stranger_within = near.stranger_within,
                         .rate_over = near.rate_over,
                         .idle = near.idle}) {
    handler.asks_token = near.asks_token;
  }

  ScriptedHandler handler;
  Served served;
  Clock::time_point started = Clock::now();
  RawClient client{served.port()};

  milliseconds passed() const { return std::chrono::duration_cast<milliseconds>(Clock::now() - started); }

  /// Sends `text` a byte every 50 ms from a thread of its own, until that is let go of.
  std::jthread drip(RawClient& dripper, std::string text) {
    return std::jthread([&dripper, text](const std::stop_token& stop) {
      for (const char byte : text) {
        if (stop.stop_requested() || !dripper.send({&byte, 1})) return;
        std::this_thread::sleep_for(patient(milliseconds(50)));
      }
    });
  }
};

class HeadDeadlines : public Deadlines {
 protected:
  HeadDeadlines() : Deadlines({.stranger_within = milliseconds(500)}) {}
};
class StrangersBodyDeadlines : public Deadlines {
 protected:
  StrangersBodyDeadlines() : Deadlines({.stranger_within = milliseconds(500), .asks_token = true}) {}
};
class RateDeadlines : public Deadlines {
 protected:
  RateDeadlines() : Deadlines({.rate_over = milliseconds(1000)}) {}
};
class IdleDeadlines : public Deadlines {
 protected:
  IdleDeadlines() : Deadlines({.rate_over = milliseconds(500), .idle = milliseconds(600)}) {}
};
class ReadingDeadlines : public Deadlines {
 protected:
  ReadingDeadlines() : Deadlines({.rate_over = milliseconds(2000), .idle = milliseconds(1000)}) {}
};

TEST_F(HeadDeadlines, CloseAClientThatSaysNothing) {
  EXPECT_TRUE(client.closes());
  EXPECT_GE(passed(), patient(milliseconds(495)));
}

TEST_F(HeadDeadlines, CloseAClientThatDripsItsHeaders) {
  const std::jthread dripping =
      drip(client, request("GET", "/echo", "X-Long: " + std::string(60, 'x') + "\r\n"));
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 408);
  EXPECT_EQ(reply->body, "\"the head of the request took too long\"");
  EXPECT_TRUE(client.closes());
}

TEST_F(IdleDeadlines, CloseAClientThatDripsTheHeadersOfItsSecondRequest) {
  client.send(request("GET", "/echo"));
  ASSERT_TRUE(client.reply());
  const std::jthread dripping = drip(client, "GET /" + std::string(400, 'x'));  // for longer than it waits
  EXPECT_TRUE(client.closes());
}

TEST_F(RateDeadlines, CloseAClientThatStopsInTheMiddleOfItsBody) {
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 100\r\n\r\nbegun");
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 408);
  EXPECT_TRUE(client.closes());
  EXPECT_TRUE(served.eventually([&] { return handler.gone == 1 && handler.exchanges == 0; }));
}

TEST_F(RateDeadlines, LetABodyThatKeepsComingTakeItsTime) {
  const std::string piece(4000, 'x');  // 80 kB a second, where a kilobyte would do
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 120000\r\n\r\n");
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(client.send(piece));
    std::this_thread::sleep_for(patient(milliseconds(50)));
  }
  EXPECT_GE(passed(), patient(milliseconds(1500)));
  EXPECT_EQ(client.reply()->status, 200);
}

TEST_F(RateDeadlines, CloseAClientThatDripsItsBody) {
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 100000\r\n\r\n");
  const std::jthread dripping = drip(client, std::string(400, 'x'));
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 408);
}

TEST_F(StrangersBodyDeadlines, CloseAClientThatDripsItsBody) {
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 100\r\n\r\n");
  const std::jthread dripping = drip(client, std::string(100, 'x'));
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 408);
}

TEST_F(StrangersBodyDeadlines, AreNotThoseOfWhoHasShownAToken) {
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nAuthorization: Bearer x\r\nContent-Length: 20\r\n\r\n");
  drip(client, std::string(20, 'x')).join();
  EXPECT_GE(passed(), patient(milliseconds(1000)));
  EXPECT_EQ(client.reply()->status, 200);
}

/// 4 MB a second of an answer that is larger than all that the kernel keeps of it: longer than an idle
/// connection is kept.
TEST_F(ReadingDeadlines, LetAClientThatReadsSteadilyTakeItsTime) {
  const std::string answer(12u << 20, 'x');
  client.send(request("GET", "/later"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  served.on_loop([&] { handler.responders[0]->answer({.body = answer, .headers = {}}); });
  EXPECT_EQ(client.read_slowly(200'000, patient(milliseconds(50)), answer.size()), answer.size());
  EXPECT_GE(passed(), patient(milliseconds(2000)));
  EXPECT_EQ(served.ended(Ended::Slow), 0u);
}

TEST_F(RateDeadlines, CloseAClientThatStopsReading) {
  client.send(request("GET", "/later"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  served.on_loop(
      [&] { handler.responders[0]->answer({.body = std::string(64u << 20, 'x'), .headers = {}}); });
  EXPECT_TRUE(served.eventually([&] { return served.server().connections() == 0; }));
  EXPECT_EQ(served.ended(Ended::Slow), 1u);
}

TEST_F(RateDeadlines, DoNotRunWhileTheGatewayHoldsTheBodyBack) {
  client.send("POST /held HTTP/1.1\r\nHost: adit\r\nContent-Length: 10\r\n\r\n01234");
  ASSERT_TRUE(served.eventually([&] { return handler.flows.size() == 1; }));
  std::this_thread::sleep_for(patient(milliseconds(1200)));
  client.send("56789");
  served.on_loop([&] { handler.flows[0]->resume(); });
  ASSERT_TRUE(served.eventually([&] { return handler.flows.size() == 2; }));
  served.on_loop([&] { handler.flows[1]->resume(); });
  EXPECT_EQ(client.reply()->status, 200);
}

TEST_F(RateDeadlines, RunAgainOnceTheBodyMayFlow) {
  client.send("POST /held HTTP/1.1\r\nHost: adit\r\nContent-Length: 10\r\n\r\n01234");
  ASSERT_TRUE(served.eventually([&] { return handler.flows.size() == 1; }));
  served.on_loop([&] { handler.flows[0]->resume(); });
  EXPECT_EQ(client.reply()->status, 408);
}

TEST_F(IdleDeadlines, DoNotRunWhileTheAnswerIsAwaited) {
  client.send(request("GET", "/later"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  std::this_thread::sleep_for(patient(milliseconds(900)));
  served.on_loop([&] { handler.responders[0]->answer({.body = "1", .headers = {}}); });
  EXPECT_EQ(client.reply()->body, "1");
}

TEST_F(IdleDeadlines, CloseAConnection) {
  client.send(request("GET", "/echo"));
  ASSERT_TRUE(client.reply());
  EXPECT_EQ(client.rest(), "");
  EXPECT_GE(passed(), patient(milliseconds(595)));
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
    std::this_thread::sleep_for(patient(milliseconds(50)));
  }
  for (auto& each : slow) EXPECT_TRUE(each->closes());
}

}  // namespace
}  // namespace adit::intake
