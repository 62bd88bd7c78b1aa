#include <gtest/gtest.h>

#include "intake/raw_client.hpp"
#include "intake/scripted_handler.hpp"
#include "intake/served.hpp"

namespace adit::intake {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = std::chrono::steady_clock;

class Deadlines : public testing::Test {
 protected:
  ScriptedHandler handler;
  Served served{handler,
                {.address = "127.0.0.1",
                 .interface = {},
                 .headers_within = milliseconds(300),
                 .body_silence = milliseconds(300),
                 .idle = milliseconds(600)}};
  RawClient client{served.port()};
  Clock::time_point started = Clock::now();

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

TEST_F(Deadlines, CloseAClientThatSaysNothing) {
  EXPECT_TRUE(client.closed_within(seconds(2)));
  EXPECT_GE(passed(), milliseconds(295));
  EXPECT_LT(passed(), milliseconds(600));
}

TEST_F(Deadlines, CloseAClientThatDripsItsHeaders) {
  std::thread dripping = drip(client, request("GET", "/echo", "X-Long: " + std::string(60, 'x') + "\r\n"));
  const auto reply = client.reply(seconds(3));
  ASSERT_TRUE(reply);
  EXPECT_LT(passed(), milliseconds(600));
  EXPECT_EQ(reply->status, 408);
  EXPECT_EQ(reply->body, "\"the head of the request took too long\"");
  dripping.join();
  EXPECT_TRUE(client.closed_within(seconds(1)));
}

TEST_F(Deadlines, CloseAClientThatDripsTheHeadersOfItsSecondRequest) {
  client.send(request("GET", "/echo"));
  ASSERT_TRUE(client.reply());
  std::thread dripping = drip(client, "GET /" + std::string(60, 'x'));
  EXPECT_TRUE(client.closed_within(seconds(3)));
  EXPECT_LT(passed(), milliseconds(1200));
  dripping.join();
}

TEST_F(Deadlines, CloseAClientThatStopsInTheMiddleOfItsBody) {
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 100\r\n\r\nbegun");
  const auto reply = client.reply(seconds(2));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 408);
  EXPECT_TRUE(client.closed_within(seconds(1)));
  EXPECT_TRUE(served.eventually([&] { return handler.gone == 1 && handler.exchanges == 0; }));
}

TEST_F(Deadlines, LetABodyThatKeepsComingTakeItsTime) {
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 12\r\n\r\n");
  drip(client, "0123456789ab").join();
  EXPECT_GE(passed(), milliseconds(600));
  EXPECT_EQ(client.reply()->body, "POST /echo  127.0.0.1 0123456789ab");
}

TEST_F(Deadlines, DoNotRunWhileTheGatewayHoldsTheBodyBack) {
  client.send("POST /held HTTP/1.1\r\nHost: adit\r\nContent-Length: 10\r\n\r\n01234");
  ASSERT_TRUE(served.eventually([&] { return handler.flows.size() == 1; }));
  std::this_thread::sleep_for(milliseconds(700));
  served.on_loop([&] { handler.flows[0]->resume(); });
  client.send("56789");
  ASSERT_TRUE(served.eventually([&] { return handler.flows.size() == 2; }));
  served.on_loop([&] { handler.flows[1]->resume(); });
  EXPECT_EQ(client.reply()->status, 200);
}

TEST_F(Deadlines, RunAgainOnceTheBodyMayFlow) {
  client.send("POST /held HTTP/1.1\r\nHost: adit\r\nContent-Length: 10\r\n\r\n01234");
  ASSERT_TRUE(served.eventually([&] { return handler.flows.size() == 1; }));
  served.on_loop([&] { handler.flows[0]->resume(); });
  EXPECT_EQ(client.reply(seconds(2))->status, 408);
}

TEST_F(Deadlines, DoNotRunWhileTheAnswerIsAwaited) {
  client.send(request("GET", "/later"));
  std::this_thread::sleep_for(milliseconds(900));
  served.on_loop([&] { handler.responders.at(0)->answer({.body = "1", .headers = {}}); });
  EXPECT_EQ(client.reply()->body, "1");
}

TEST_F(Deadlines, CloseAnIdleConnection) {
  client.send(request("GET", "/echo"));
  ASSERT_TRUE(client.reply());
  EXPECT_EQ(client.rest(seconds(3)), "");
  EXPECT_GE(passed(), milliseconds(595));
  EXPECT_LT(passed(), milliseconds(1200));
}

TEST_F(Deadlines, CloseAClientThatDoesNotReadItsAnswer) {
  client.send(request("GET", "/later"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  served.on_loop(
      [&] { handler.responders[0]->answer({.body = std::string(64u << 20, 'x'), .headers = {}}); });
  EXPECT_TRUE(served.eventually([&] { return served.server().connections() == 0; }, seconds(5)));
}

TEST_F(Deadlines, OfSomeLeaveOthersServed) {
  std::vector<std::unique_ptr<RawClient>> slow;
  for (int i = 0; i < 10; ++i) {
    slow.push_back(std::make_unique<RawClient>(served.port()));
    slow.back()->send("GET /echo HTT");
  }
  for (int i = 0; i < 10; ++i) {
    client.send(request("POST", "/echo", {}, "fine"));
    EXPECT_EQ(client.reply(seconds(1))->status, 200);
    std::this_thread::sleep_for(milliseconds(50));
  }
  for (auto& each : slow) EXPECT_TRUE(each->closed_within(seconds(1)));
}

}  // namespace
}  // namespace adit::intake
