// Requests that the gate passes to a handler or rejects.
#include "intake/gate.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>
#include <nlohmann/json.hpp>

#include "intake/odd_heads.hpp"
#include "intake/raw_client.hpp"
#include "intake/scripted_handler.hpp"
#include "intake/served.hpp"

namespace adit::intake {
namespace {

using std::chrono::milliseconds;

class GateTest : public testing::Test {
 protected:
  ScriptedHandler handler;
  Served served{handler};

  /// One answer of Adit, then the end of the connection.
  static void expect_refused(RawClient& client, int status, std::string_view word) {
    const auto reply = client.reply();
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, status);
    EXPECT_EQ(reply->header("connection"), "close");
    EXPECT_EQ(reply->header("content-type"), "application/json");
    const auto sentence = nlohmann::json::parse(reply->body, nullptr, false);
    EXPECT_TRUE(sentence.is_string() && reply->body.find(word) != std::string::npos) << reply->body;
    EXPECT_EQ(client.rest(), "");
  }
};

TEST_F(GateTest, RejectsOddHeadsFirstAndLater) {
  RecordProperty("cases", static_cast<int>(2 * odd_heads().size()));  // tests/hostile/run counts them
  for (const OddHead& odd : odd_heads()) {
    SCOPED_TRACE(std::string(odd.clause) + " " + std::string(odd.what));
    RawClient first(served.port());
    first.send(odd.head);
    expect_refused(first, odd.status, odd.word);
    RawClient later(served.port());
    later.send(request("POST", "/echo", {}, "fine"));
    ASSERT_EQ(later.reply()->status, 200);
    later.send(odd.head);
    expect_refused(later, odd.status, odd.word);
  }
  EXPECT_EQ(handler.ends, static_cast<int>(odd_heads().size()));  // the valid requests
}

/// cpp-httplib writes head and body apart. On a kept connection the kernel else acknowledges after 40 ms.
TEST_F(GateTest, AcknowledgesAHeadBeforeItsBody) {
  RawClient client(served.port());
  client.delay_small_writes();
  auto least = std::chrono::steady_clock::duration::max();
  for (int i = 0; i < 40; ++i) {
    const auto begun = std::chrono::steady_clock::now();
    client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 1\r\n\r\n");
    client.send("x");
    ASSERT_EQ(client.reply()->status, 200);
    const bool is_quick_by_itself = i < 20;  // a new connection's first bytes
    if (!is_quick_by_itself) least = std::min(least, std::chrono::steady_clock::now() - begun);
  }
  EXPECT_LT(least, milliseconds(30));
}

TEST_F(GateTest, ReadsNothingAfterAPipelinedOddHead) {
  RecordProperty("cases", static_cast<int>(odd_heads().size()));  // tests/hostile/run counts them
  for (const OddHead& odd : odd_heads()) {
    SCOPED_TRACE(odd.what);
    RawClient client(served.port());
    client.send(request("POST", "/echo", {}, "fine") + odd.head + request("GET", "/echo?q=smuggled"));
    const auto reply = client.reply();
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 200);
    const auto rest = client.rest();
    ASSERT_TRUE(rest);
    EXPECT_EQ(rest->find("200 OK"), std::string::npos) << *rest;
    EXPECT_EQ(rest->find("<html>"), std::string::npos) << *rest;
  }
}

TEST_F(GateTest, RejectsOddChunks) {
  RecordProperty("cases", static_cast<int>(odd_chunks().size()));  // tests/hostile/run counts them
  for (const OddChunks& odd : odd_chunks()) {
    SCOPED_TRACE(odd.what);
    RawClient client(served.port());
    client.send(request("POST", "/echo", "Transfer-Encoding: chunked\r\n") + odd.body);
    expect_refused(client, 400, "chunked body");
  }
  EXPECT_EQ(handler.ends, 0);
  EXPECT_TRUE(served.eventually([&] { return handler.exchanges == 0; }));
}

TEST_F(GateTest, ClosesAfterTheAnswerToAChunkedBody) {
  RawClient client(served.port());
  client.send(request("POST", "/later", "Transfer-Encoding: chunked\r\n") + "4\r\nbody\r\n0\r\n\r\n");
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  served.on_loop([&] { handler.responders[0]->answer({.body = "1", .headers = {}}); });
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->body, "1");
  EXPECT_EQ(reply->header("connection"), "close");
  EXPECT_EQ(client.rest(), "");
}

TEST_F(GateTest, HoldsAChunkedBodyBack) {
  RawClient client(served.port());
  client.send(request("POST", "/held", "Transfer-Encoding: chunked\r\n") + "4\r\nbody\r\n0\r\n\r\n");
  ASSERT_TRUE(served.eventually([&] { return handler.flows.size() == 1; }));
  served.turn_often();
  EXPECT_EQ(handler.ends, 0);
  served.on_loop([&] { handler.flows[0]->resume(); });
  EXPECT_EQ(client.reply()->body, "POST /held  127.0.0.1 body");
}

TEST_F(GateTest, SendsContinueForAChunkedBody) {
  RawClient client(served.port());
  client.send(request("POST", "/echo", "Expect: 100-continue\r\nTransfer-Encoding: chunked\r\n"));
  ASSERT_TRUE(client.wait_for("HTTP/1.1 100 Continue\r\n\r\n"));
  for (const char byte : std::string("4\r\nbody\r\n0\r\n\r\n")) client.send({&byte, 1});
  EXPECT_EQ(client.reply()->body, "POST /echo  127.0.0.1 body");
}

TEST_F(GateTest, ReadsNothingAfterAChunkedBody) {
  RawClient client(served.port());
  client.send(request("POST", "/echo", "Transfer-Encoding: chunked\r\n") + "1\r\nx\r\n0\r\n\r\n" +
              request("GET", "/echo?q=next"));
  EXPECT_EQ(client.reply()->body, "POST /echo  127.0.0.1 x");
  EXPECT_EQ(client.rest(), "");
  EXPECT_EQ(handler.ends, 1);
}

TEST_F(GateTest, DropsAPipelinedChunkedRequest) {
  RawClient client(served.port());
  client.send(request("POST", "/echo", {}, "x") + request("POST", "/echo", "Transfer-Encoding: chunked\r\n") +
              "1\r\ny\r\n0\r\n\r\n");
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->body, "POST /echo  127.0.0.1 x");
  EXPECT_EQ(reply->header("connection"), "close");
  EXPECT_EQ(client.rest(), "");
  EXPECT_EQ(handler.ends, 1);
}

TEST_F(GateTest, DropsAPipelinedPartOfAHead) {
  RawClient client(served.port());
  client.send(request("POST", "/echo", {}, "x") + "GET /echo HTTP/1.1\r\nHo");
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->body, "POST /echo  127.0.0.1 x");
  EXPECT_EQ(reply->header("connection"), "close");
  EXPECT_EQ(client.rest(), "");
}

TEST_F(GateTest, AcceptsTheLargestHeadWithItsBody) {
  std::string fields = "Content-Length: 50000\r\nCookie: ";
  for (int i = 0; i < 40; ++i) fields += "a" + std::to_string(i) + "=" + std::string(80, 'c') + "; ";
  fields.resize(8 + 26 + 4000, 'c');
  fields += "\r\n";
  const std::string begin = "POST /echo?a&b&c=d HTTP/1.1\r\nHost: adit\r\n";
  for (int i = 0; i < 80; ++i) fields += "X: 1\r\n";
  fields += "Y: " + std::string(HeadChecker::kMostBytes - begin.size() - fields.size() - 7, 'y') + "\r\n";
  const std::string head = begin + fields + "\r\n";
  ASSERT_EQ(head.size(), HeadChecker::kMostBytes);
  RawClient client(served.port());
  for (int i = 0; i < 2; ++i) {
    client.send(head + std::string(50000, 'b'));
    const auto reply = client.reply();
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 200) << reply->body.substr(0, 200);
    EXPECT_GE(reply->body.size(), 50000u);
  }
}

TEST_F(GateTest, RejectsAHeadRequestWithoutABody) {
  RawClient client(served.port());
  client.send("HEAD /echo HTTP/1.1\r\n\r\n");
  EXPECT_EQ(client.reply(milliseconds(10000), true)->status, 400);
  EXPECT_EQ(client.rest(), "");
}

TEST_F(GateTest, ClosesIfTheClientEndsInItsHead) {
  RawClient client(served.port());
  client.send("GET /echo HTTP/1.1\r\nHost: ad");
  client.half_close();
  EXPECT_EQ(client.rest(), "");
}

TEST(GateWithDrips, ChecksAHeadAfterGrowthOrAWhile) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
  const loop::FileDescriptor client(ends[0]), server(ends[1]);
  Gate gate(server.get());
  loop::Instant now{};
  const auto come = [&](std::string_view bytes) {
    EXPECT_EQ(::send(client.get(), bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
    return gate.check_bytes(now, false);
  };
  EXPECT_EQ(come("GET /echo HTTP/1.1\r\nHost: adit\r\nX: " + std::string(2000, 'x')), Gate::Finding::Begun);
  EXPECT_EQ(gate.check_bytes(now, false), Gate::Finding::Begun);
  int looks = 0;
  for (int i = 0; i < 150; ++i) looks += come("x") == Gate::Finding::Later ? 0 : 1;
  EXPECT_LE(looks, 1);
  EXPECT_EQ(come("\r\n\r\n"), Gate::Finding::Later);
  EXPECT_EQ(gate.check_bytes(now, true), Gate::Finding::Whole) << "the client has ended";
}

}  // namespace
}  // namespace adit::intake
