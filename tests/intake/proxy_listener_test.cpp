// Connections that stunnel passes on.
#include "intake/proxy_listener.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "intake/odd_heads.hpp"
#include "intake/raw_client.hpp"
#include "intake/scripted_handler.hpp"
#include "intake/served.hpp"

namespace adit::intake {
namespace {

using enum ProxyHeader::Missing;
using std::chrono::milliseconds;

constexpr std::string_view kFromRobot = "PROXY TCP4 10.0.0.5 10.0.0.1 49152 443\r\n";

TEST(ProxyHeader, NamesBothEnds) {
  struct {
    std::string_view line, peer, local;
  } const rows[] = {
      {"PROXY TCP4 10.0.0.5 10.0.0.1 49152 443", "10.0.0.5", "10.0.0.1"},
      {"PROXY TCP6 ::ffff:10.0.0.5 ::ffff:10.0.0.1 49152 443", "10.0.0.5", "10.0.0.1"},
      {"PROXY TCP6 fe80::0:5%team0 FE80::1%team0 49152 443", "fe80::5", "fe80::1"},
      {"PROXY TCP6 ffff:ffff:ffff:ffff:ffff:ffff:ffff:fff1 ffff:ffff:ffff:ffff:ffff:ffff:ffff:ffff 65535 "
       "65535",
       "ffff:ffff:ffff:ffff:ffff:ffff:ffff:fff1", "ffff:ffff:ffff:ffff:ffff:ffff:ffff:ffff"},
  };
  for (const auto& row : rows) {
    SCOPED_TRACE(row.line);
    const std::string bytes = std::string(row.line) + "\r\n";
    for (std::size_t size = 0; size < bytes.size(); ++size)
      EXPECT_EQ(ProxyHeader::parse(bytes.substr(0, size)), std::unexpected(More)) << size;
    const auto header = ProxyHeader::parse(bytes + "GET / HTTP/1.1\r\n");
    ASSERT_TRUE(header);
    EXPECT_EQ(header->size, bytes.size());
    EXPECT_EQ(header->peer, row.peer);
    EXPECT_EQ(header->local, row.local);
  }
}

const std::string_view kNoHeaders[] = {
    "GET / HTTP/1.1\r\n",
    "proxy TCP4 10.0.0.5 10.0.0.1 49152 443\r\n",
    " PROXY TCP4 10.0.0.5 10.0.0.1 49152 443\r\n",
    "PROXY UNKNOWN\r\n",
    "PROXY UNKNOWN 10.0.0.5 10.0.0.1 49152 443\r\n",
    "PROXY TCP 10.0.0.5 10.0.0.1 49152 443\r\n",
    "PROXY TCP5 10.0.0.5 10.0.0.1 49152 443\r\n",
    "PROXY TCP4 10.0.0.5 10.0.0.1 49152\r\n",
    "PROXY TCP4 10.0.0.5 10.0.0.1 49152 \r\n",
    "PROXY TCP4 10.0.0.5 10.0.0.1 49152 443 1\r\n",
    "PROXY TCP4 10.0.0.5  10.0.0.1 49152 443\r\n",
    "PROXY TCP4 10.0.0.5 10.0.0.1 49152 65536\r\n",
    "PROXY TCP4 10.0.0.5 10.0.0.1 -1 443\r\n",
    "PROXY TCP4 10.0.0.256 10.0.0.1 49152 443\r\n",
    "PROXY TCP4 10.0.0 10.0.0.1 49152 443\r\n",
    "PROXY TCP4 ::1 ::1 49152 443\r\n",
    "PROXY TCP6 10.0.0.5 10.0.0.1 49152 443\r\n",
    "PROXY TCP4 adit.local 10.0.0.1 49152 443\r\n",
    "PROXY TCP4 10.0.0.5\n10.0.0.1 49152 443\r\n",
    "PROXY TCP4 10.0.0.5 10.0.0.1 49152 443 and much more than the 107 bytes of the longest header "
    "........\r\n",
    "\r\n\r\n\0\r\nQUIT\n\x21\x11",
};

TEST(ProxyHeader, HasNoOtherForm) {
  for (const std::string_view bytes : kNoHeaders)
    EXPECT_EQ(ProxyHeader::parse(bytes), std::unexpected(Refused)) << bytes;
}

class ProxyListenerTest : public testing::Test {
 protected:
  std::unique_ptr<RawClient> robot(std::string_view bytes) {
    auto client = std::make_unique<RawClient>(served.port());
    client->send(std::string(kFromRobot) + std::string(bytes));
    return client;
  }

  ScriptedHandler handler;
  Served served{handler, {.address = {}, .interface = {}, .by_tls = true}};
};

TEST_F(ProxyListenerTest, RequestsHaveTheAddressOfTheirClient) {
  const auto client = robot(request("POST", "/echo", {}, "1"));
  EXPECT_EQ(client->reply()->body, "POST /echo  10.0.0.5 1");
  client->send(request("POST", "/echo", "Transfer-Encoding: chunked\r\n") + "1\r\n2\r\n0\r\n\r\n");
  EXPECT_EQ(client->reply()->body, "POST /echo  10.0.0.5 2");
}

TEST_F(ProxyListenerTest, HeaderMayArriveInPieces) {
  RawClient client(served.port());
  for (const char byte : std::string(kFromRobot) + request("GET", "/echo")) {
    client.send({&byte, 1});
    served.on_loop([] {});
  }
  EXPECT_EQ(client.reply()->body, "GET /echo  10.0.0.5 ");
}

TEST_F(ProxyListenerTest, ClosesConnectionsWithoutAHeader) {
  RecordProperty("cases", static_cast<int>(std::size(kNoHeaders)));  // tests/hostile/run counts them
  for (const std::string_view bytes : kNoHeaders) {
    SCOPED_TRACE(bytes);
    RawClient client(served.port());
    client.send(bytes);
    client.send(request("GET", "/echo"));
    EXPECT_TRUE(client.closes());
  }
  EXPECT_EQ(handler.ends, 0);
}

TEST_F(ProxyListenerTest, GateCountsTheBytesAfterTheHeader) {
  const auto keeps = robot(request("POST", "/echo", {}, "1") + request("POST", "/echo", {}, "2"));
  EXPECT_EQ(keeps->reply()->header("connection"), "");
  EXPECT_EQ(keeps->reply()->header("connection"), "");
  const auto ends = robot(request("POST", "/echo", {}, "1") + "GET /echo HTTP/1.1\r\nHo");
  EXPECT_EQ(ends->reply()->header("connection"), "close");
  EXPECT_EQ(ends->rest(), "");
}

TEST_F(ProxyListenerTest, SecondHeaderIsAnOddHead) {
  EXPECT_EQ(robot(std::string(kFromRobot) + request("GET", "/echo"))->reply()->status, 400);
}

TEST_F(ProxyListenerTest, RejectsOddHeads) {
  RecordProperty("cases", static_cast<int>(odd_heads().size()));  // tests/hostile/run counts them
  for (const OddHead& odd : odd_heads()) {
    SCOPED_TRACE(odd.what);
    EXPECT_EQ(robot(odd.head)->reply()->status, odd.status);
  }
}

TEST_F(ProxyListenerTest, WaitsForFewHeaders) {
  std::vector<std::unique_ptr<RawClient>> silent;
  for (std::size_t i = 0; i <= ProxyListener::kMostWaiting; ++i)
    silent.push_back(std::make_unique<RawClient>(served.port()));
  EXPECT_TRUE(silent.front()->closes());
  const auto client = robot(request("GET", "/echo"));
  EXPECT_EQ(client->reply()->status, 200);
  EXPECT_EQ(served.on_loop([&] { return served.server().connections(); }), 1u);
}

TEST(ProxyListenerWithinAWhile, WaitsForAHeader) {
  ScriptedHandler handler;
  Served served{handler,
                {.address = {}, .interface = {}, .by_tls = true, .unauthenticated_within = milliseconds(50)}};
  RawClient silent(served.port()), partial(served.port());
  partial.send(kFromRobot.substr(0, 20));
  EXPECT_TRUE(silent.closes());
  EXPECT_TRUE(partial.closes());
}

TEST(ProxyListenerWithShares, EachClientHasItsOwn) {
  ScriptedHandler handler;
  Served served{
      handler,
      {.address = {}, .interface = {}, .by_tls = true, .connections = 8, .connections_per_address = 1}};
  std::vector<std::unique_ptr<RawClient>> held;
  const auto connect = [&](const std::string& from) {
    held.push_back(std::make_unique<RawClient>(served.port()));
    held.back()->send("PROXY TCP4 " + from + " 10.0.0.1 49152 443\r\n" + request("GET", "/later"));
  };
  connect("10.0.0.5");
  connect("10.0.0.6");
  EXPECT_TRUE(served.eventually([&] { return handler.responders.size() == 2; }));
  connect("10.0.0.5");
  EXPECT_EQ(held.back()->reply()->status, 503);
}

}  // namespace
}  // namespace adit::intake
