#include "intake/server.hpp"

#include <gtest/gtest.h>

#include "intake/raw_client.hpp"
#include "intake/scripted_handler.hpp"
#include "intake/served.hpp"

namespace adit::intake {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class ServerTest : public testing::Test {
 protected:
  ScriptedHandler handler;
  Served served{handler};
  RawClient client{served.port()};

  void SetUp() override { ASSERT_TRUE(client.connected()) << served.error(); }
};

TEST_F(ServerTest, PassesMethodPathQueryAndPeerToTheHandler) {
  client.send(request("GET", "/echo?q=a%20b"));
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 200);
  EXPECT_EQ(reply->body, "GET /echo a b 127.0.0.1 ");
  EXPECT_EQ(reply->header("content-type"), "text/plain");
  EXPECT_EQ(reply->header("x-echo"), "yes");
}

TEST_F(ServerTest, AcceptsABodyByLengthAndInChunks) {
  client.send(request("POST", "/echo", {}, "by length"));
  EXPECT_EQ(client.reply()->body, "POST /echo  127.0.0.1 by length");
  client.send(request("POST", "/echo", "Transfer-Encoding: chunked\r\n") +
              "3;ext=1\r\nin \r\n6\r\nchunks\r\n0\r\nTrailer: x\r\n\r\n");
  EXPECT_EQ(client.reply()->body, "POST /echo  127.0.0.1 in chunks");
}

TEST_F(ServerTest, AnswersPipelinedRequestsInOrder) {
  client.send(request("POST", "/echo", {}, "one") + request("GET", "/echo?q=two") +
              request("POST", "/echo", {}, "three"));
  EXPECT_EQ(client.reply()->body, "POST /echo  127.0.0.1 one");
  EXPECT_EQ(client.reply()->body, "GET /echo two 127.0.0.1 ");
  EXPECT_EQ(client.reply()->body, "POST /echo  127.0.0.1 three");
}

TEST_F(ServerTest, AcceptsARequestByteByByte) {
  for (const char byte : request("POST", "/echo", {}, "slowly")) client.send({&byte, 1});
  EXPECT_EQ(client.reply()->body, "POST /echo  127.0.0.1 slowly");
}

TEST_F(ServerTest, AnswersHeadWithoutABody) {
  client.send(request("HEAD", "/echo"));
  const auto reply = client.reply(seconds(10), true);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 200);
  client.send(request("GET", "/echo"));
  EXPECT_EQ(client.reply()->body, "GET /echo  127.0.0.1 ");
}

TEST_F(ServerTest, SendsContinueOnRequest) {
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nExpect: 100-continue\r\nContent-Length: 4\r\n\r\n");
  ASSERT_TRUE(client.wait_for("HTTP/1.1 100 Continue\r\n\r\n"));
  client.send("body");
  EXPECT_EQ(client.reply()->body, "POST /echo  127.0.0.1 body");
}

TEST_F(ServerTest, RejectsInsteadOfSendingContinue) {
  for (const std::string method : {"POST", "PUT", "DELETE"}) {
    RawClient waiting(served.port());
    waiting.send(
        method +
        " /refuse HTTP/1.1\r\nHost: adit\r\nExpect: 100-continue\r\nContent-Length: 90000000\r\n\r\n");
    const auto reply = waiting.reply();
    ASSERT_TRUE(reply) << method;
    EXPECT_EQ(reply->status, 401) << method;
    EXPECT_EQ(reply->body, "\"no\"");
    EXPECT_EQ(waiting.rest(), "") << method;
  }
}

TEST_F(ServerTest, KeepsTheConnectionAfterRejectingASmallBody) {
  client.send(request("POST", "/refuse", {}, std::string(1000, 'x')));
  EXPECT_EQ(client.reply()->status, 401);
  client.send(request("GET", "/echo"));
  EXPECT_EQ(client.reply()->status, 200);
}

TEST_F(ServerTest, RejectsALargeBodyAtOnce) {
  const std::string body(50u << 20, 'x');
  client.send("POST /refuse HTTP/1.1\r\nHost: adit\r\nContent-Length: " + std::to_string(body.size()) +
              "\r\n\r\n");
  client.send_until_stalled(body, milliseconds(200));
  const auto reply = client.reply();
  ASSERT_TRUE(reply) << "a reset has lost the answer";
  EXPECT_EQ(reply->status, 401);
  EXPECT_EQ(reply->body, "\"no\"");
  EXPECT_EQ(reply->header("connection"), "close");
}

TEST_F(ServerTest, DiscardsARejectedBodyOfAnySize) {
  const std::string piece(50 << 20, 'x');
  constexpr std::size_t kPieces = 6;  // more than the largest map: a disk's image in place of an update
  client.send("POST /refuse HTTP/1.1\r\nHost: adit\r\nContent-Length: " +
              std::to_string(kPieces * piece.size()) + "\r\n\r\n");
  for (std::size_t i = 0; i < kPieces; ++i) {
    ASSERT_EQ(client.send_until_stalled(piece, std::chrono::seconds(10)), piece.size()) << i;
  }
  EXPECT_EQ(client.reply()->status, 401);
}

TEST_F(ServerTest, RejectsInTheMiddleOfABody) {
  client.send("POST /midway HTTP/1.1\r\nHost: adit\r\nContent-Length: 50000000\r\n\r\nfirst");
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 422);
  EXPECT_EQ(reply->body, "\"midway\"");
  EXPECT_EQ(handler.ends, 0);
}

TEST_F(ServerTest, RejectsInTheMiddleOfAChunkedBody) {
  client.send(request("POST", "/midway", "Transfer-Encoding: chunked\r\n") + "5\r\nfirst\r\n");
  EXPECT_EQ(client.reply()->body, "\"midway\"");
}

TEST_F(ServerTest, AnswersLater) {
  client.send(request("POST", "/later", {}, "x"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  EXPECT_FALSE(client.reply(milliseconds(50)));
  served.on_loop([&] { handler.responders[0]->answer({.body = "1", .headers = {}}); });
  EXPECT_EQ(client.reply()->body, "1");
  client.send(request("GET", "/echo"));
  EXPECT_EQ(client.reply()->status, 200);
}

TEST_F(ServerTest, SendsOneAnswerPerRequest) {
  client.send(request("GET", "/later"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  served.on_loop([&] {
    handler.responders[0]->answer({.body = "1", .headers = {}});
    handler.responders[0]->answer({.body = "2", .headers = {}});
    EXPECT_FALSE(handler.responders[0]->stream("text/plain")->send("3"));
  });
  EXPECT_EQ(client.reply()->body, "1");
  client.half_close();
  EXPECT_EQ(client.rest(), "");
}

TEST_F(ServerTest, AnswersBeforeTheBodyHasEnded) {
  client.send("POST /eager HTTP/1.1\r\nHost: adit\r\nContent-Length: 5000000\r\n\r\nfirst");
  ASSERT_TRUE(served.eventually([&] { return handler.body_bytes == 5; }));
  served.on_loop([&] { handler.responders[0]->answer(error_answer(icd::Status::TooManyRequests, "busy")); });
  EXPECT_EQ(client.reply()->status, 429);
}

TEST_F(ServerTest, AnswersIfAHandlerDoesNothing) {
  client.send(request("GET", "/nothing"));
  EXPECT_EQ(client.reply()->status, 500);
}

TEST_F(ServerTest, AnswersAClientAfterAHalfClose) {
  client.send(request("GET", "/later"));
  client.half_close();
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  std::this_thread::sleep_for(milliseconds(50));
  served.on_loop([&] {
    EXPECT_FALSE(handler.responders[0]->is_client_gone());
    handler.responders[0]->answer({.body = "1", .headers = {}});
  });
  EXPECT_EQ(client.reply()->body, "1");
}

TEST_F(ServerTest, HoldsABodyBackOnRequest) {
  const std::string body(16u << 20, 'x');
  client.send("POST /held HTTP/1.1\r\nHost: adit\r\nContent-Length: " + std::to_string(body.size()) +
              "\r\n\r\n");
  std::size_t sent = client.send_until_stalled(body, milliseconds(300));
  EXPECT_LT(sent, body.size());
  EXPECT_LE(handler.body_bytes, 256u << 10);
  std::thread rest([&] { client.send(std::string_view(body).substr(sent)); });
  while (handler.ends == 0) {
    served.on_loop([&] {
      for (const auto& flow : std::exchange(handler.flows, {})) flow->resume();
    });
  }
  rest.join();
  EXPECT_EQ(client.reply()->status, 200);
}

TEST_F(ServerTest, StreamsEachPieceAtOnce) {
  client.send(request("GET", "/stream"));
  ASSERT_TRUE(served.eventually([&] { return handler.streams.size() == 1; }));
  for (const char* event : {"data: 1\n\n", "data: 2\n\n", "data: 3\n\n"}) {
    served.on_loop([&] { EXPECT_TRUE(handler.streams[0]->send(event)); });
    EXPECT_TRUE(client.wait_for(event));
  }
  served.on_loop([&] { handler.streams.clear(); });
  EXPECT_TRUE(client.wait_for("0\r\n\r\n"));
  client.send(request("GET", "/echo"));
  EXPECT_EQ(client.reply()->status, 200);
}

TEST_F(ServerTest, ReplacesOnlyUnsentPiecesOfAStream) {
  client.send(request("GET", "/stream"));
  ASSERT_TRUE(served.eventually([&] { return handler.streams.size() == 1; }));
  // More than the sockets hold, so that some of it is unsent.
  const std::string begun(300'000, 'a'), old(100'000, 'z'), end = "data: the end\n\n";
  EXPECT_TRUE(served.eventually([&] {
    EXPECT_TRUE(handler.streams[0]->send(begun));
    return handler.streams[0]->waiting() > begun.size();
  }));
  served.on_loop([&] {
    EXPECT_TRUE(handler.streams[0]->send(old));
    EXPECT_TRUE(handler.streams[0]->send_instead(end));
    EXPECT_LE(handler.streams[0]->waiting(), begun.size() + end.size());
    handler.streams.clear();
  });
  const auto reply = client.reply(std::chrono::seconds(60));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->body.find_first_not_of('a'), reply->body.size() - end.size())
      << "nothing of the replaced piece";
  EXPECT_TRUE(reply->body.ends_with(end));
}

TEST_F(ServerTest, EndsAStreamThatIsNotRead) {
  client.send(request("GET", "/stream"));
  ASSERT_TRUE(served.eventually([&] { return handler.streams.size() == 1; }));
  const std::string event(64 * 1024, 'x');
  EXPECT_TRUE(served.eventually([&] { return !handler.streams[0]->send(event); }));
  EXPECT_TRUE(served.eventually([&] { return served.server().connections() == 0; }));
}

TEST_F(ServerTest, DecodesThePathAndRejectsInvalidText) {
  client.send(request("GET", "/%65cho"));
  EXPECT_EQ(client.reply()->status, 200);
  client.send(request("GET", "/a%00b"));
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 400);
  EXPECT_TRUE(reply->body.starts_with("\"request target")) << reply->body;
}

TEST_F(ServerTest, RejectsConnectionsAfterStopListening) {
  client.send(request("GET", "/later"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  served.on_loop([&] { served.server().stop_listening(); });
  EXPECT_FALSE(RawClient(served.port()).connected());
  served.on_loop([&] { handler.responders[0]->answer({.body = "1", .headers = {}}); });
  EXPECT_EQ(client.reply()->body, "1");
}

TEST(ServerStart, ExplainsWhyItCannotListen) {
  ScriptedHandler handler;
  Served first(handler);
  Served second(handler, {.address = "127.0.0.1", .port = first.port(), .interface = {}});
  EXPECT_NE(second.error().find("127.0.0.1 port " + std::to_string(first.port())), std::string::npos)
      << second.error();
  Served third(handler, {.address = "not an address", .interface = {}});
  EXPECT_NE(third.error().find("not an IP address"), std::string::npos) << third.error();
  Served fourth(handler, {.address = "127.0.0.1", .interface = "nosuch0"});
  EXPECT_NE(fourth.error().find("nosuch0"), std::string::npos) << fourth.error();
}

TEST(ServerStart, ShowsAMappedAddressAsIPv4) {
  ScriptedHandler handler;
  Served served(handler, {.address = "::", .interface = {}});
  if (!served.error().empty()) GTEST_SKIP() << "no IPv6 here: " << served.error();
  RawClient client(served.port());
  client.send(request("GET", "/echo"));
  EXPECT_EQ(client.reply()->body, "GET /echo  127.0.0.1 ");
}

}  // namespace
}  // namespace adit::intake
