#include <gmock/gmock.h>

#include <string>

#include "asking.hpp"

namespace adit::uplink {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

class WarmConnection : public Asking {};

TEST_F(WarmConnection, ConnectsAheadOfNeed) {
  const ListeningPeer peer(always(answer("200 OK", "null")));
  Connection connection(loop_, peer.endpoint(), token());
  EXPECT_FALSE(connection.connected());
  connection.keep_warm();
  EXPECT_TRUE(turn_until([&] { return connection.connected(); }));
  EXPECT_EQ(answered(ask(connection, get())).status, 200);
  EXPECT_EQ(peer.begun(), 1);
}

TEST_F(WarmConnection, TakesARequestWhileItStillConnects) {
  const ListeningPeer peer(always(answer("200 OK", "null")));
  Connection connection(loop_, peer.endpoint(), token());
  connection.keep_warm();
  EXPECT_EQ(answered(ask(connection, get())).status, 200);
  EXPECT_EQ(peer.begun(), 1);
}

TEST_F(WarmConnection, SaysItsTroubleAndConnectsOnceItCan) {
  Peer peer({always(answer("200 OK", "null"))});
  Connection connection(loop_, peer.endpoint(), token());
  connection.keep_warm();
  EXPECT_TRUE(turn_until([&] { return !connection.trouble().empty(); }));
  EXPECT_THAT(connection.trouble(), HasSubstr("Connection refused"));
  EXPECT_FALSE(connection.busy());
  peer.listen();
  EXPECT_TRUE(turn_until([&] { return connection.connected(); }));
  EXPECT_EQ(connection.trouble(), "");
}

TEST_F(WarmConnection, WaitsForNoPauseWhereTheWayMayBeBack) {
  Peer peer({always(answer("200 OK", "null"))});
  Connection connection(loop_, peer.endpoint(), token());
  connection.keep_warm();
  EXPECT_TRUE(turn_until([&] { return !connection.trouble().empty(); }));
  peer.listen();
  connection.hurry();
  const loop::Instant before = loop_.now();
  EXPECT_TRUE(turn_until([&] { return connection.connected(); }));
  EXPECT_LT(loop_.now() - before, milliseconds(500));
  connection.hurry();
  EXPECT_TRUE(connection.connected()) << "what is there stays";
}

TEST_F(WarmConnection, DoesNotHammerAPeerThatClosesAtOnce) {
  const ListeningPeer peer([](Wire&) {});
  Connection connection(loop_, peer.endpoint(), token());
  connection.keep_warm();
  const loop::Instant end = loop_.now() + milliseconds(300);
  while (loop_.now() < end) loop_.turn(milliseconds(5));
  EXPECT_EQ(peer.begun(), 1);
}

TEST_F(WarmConnection, ConnectsAgainAfterAnAnswerThatEndsIt) {
  const ListeningPeer peer(always(answer("422 No", "\"no\"")));
  Connection connection(loop_, peer.endpoint(), token());
  connection.keep_warm();
  EXPECT_EQ(answered(ask(connection, get())).status, 422);
  EXPECT_FALSE(connection.connected());
  EXPECT_TRUE(turn_until([&] { return connection.connected(); }));
}

TEST_F(WarmConnection, DoesNotMakeARequestWaitForItsPause) {
  Peer peer({always(answer("200 OK", "null"))});
  Connection connection(loop_, peer.endpoint(), token());
  connection.keep_warm();
  EXPECT_TRUE(turn_until([&] { return !connection.trouble().empty(); }));
  peer.listen();
  const loop::Instant before = loop_.now();
  EXPECT_EQ(answered(ask(connection, get())).status, 200);
  EXPECT_LT(loop_.now() - before, milliseconds(800)) << "it waited for the next attempt";
}

TEST_F(WarmConnection, DiesQuietly) {
  const ListeningPeer peer(always(answer("200 OK", "null")));
  for (int turns = 0; turns < 6; ++turns) {
    Connection connection(loop_, peer.endpoint(), token());
    connection.keep_warm();
    for (int i = 0; i < turns; ++i) loop_.turn(milliseconds(1));
  }
  for (int i = 0; i < 3; ++i) loop_.turn(milliseconds(1));
}

}  // namespace
}  // namespace adit::uplink
