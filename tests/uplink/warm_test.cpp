#include <gmock/gmock.h>

#include <string>

#include "asking.hpp"

namespace adit::uplink {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

class WarmConnection : public Asking {
 protected:
  /// Makes a connection that pauses after a failed attempt, and could now succeed. Returns how long `then`
  /// takes.
  loop::Duration of_one_that_pauses(const std::function<void(Connection&)>& then) {
    Peer peer({always(answer("200 OK", "null"))});
    Connection connection(loop_, peer.endpoint(), token());
    connection.keep_warm();
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return !connection.trouble().empty(); }));
    peer.listen();
    const loop::Instant before = loop_.now();
    then(connection);
    return loop_.now() - before;
  }
  /// Whether it does not wait for the pause of a second, which a busy machine sometimes takes by itself.
  bool is_quick(const std::function<void(Connection&)>& then) {
    for (int attempt = 0; attempt < 10; ++attempt) {
      if (of_one_that_pauses(then) < milliseconds(500)) return true;
    }
    return false;
  }
};

TEST_F(WarmConnection, ConnectsAheadOfNeed) {
  const ListeningPeer peer(always(answer("200 OK", "null")));
  Connection connection(loop_, peer.endpoint(), token());
  EXPECT_FALSE(connection.is_connected());
  connection.keep_warm();
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return connection.is_connected(); }));
  EXPECT_EQ(answered(ask(connection, get())).status, 200);
  EXPECT_EQ(peer.begun(), 1);
}

TEST_F(WarmConnection, AcceptsARequestWhileConnecting) {
  const ListeningPeer peer(always(answer("200 OK", "null")));
  Connection connection(loop_, peer.endpoint(), token());
  connection.keep_warm();
  EXPECT_EQ(answered(ask(connection, get())).status, 200);
  EXPECT_EQ(peer.begun(), 1);
}

TEST_F(WarmConnection, ReportsTroubleAndConnectsLater) {
  Peer peer({always(answer("200 OK", "null"))});
  Connection connection(loop_, peer.endpoint(), token());
  connection.keep_warm();
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return !connection.trouble().empty(); }));
  EXPECT_THAT(connection.trouble(), HasSubstr("Connection refused"));
  EXPECT_FALSE(connection.busy());
  peer.listen();
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return connection.is_connected(); }));
  EXPECT_EQ(connection.trouble(), "");
}

TEST_F(WarmConnection, RetriesAtOnceIfTheNetworkMayBeBack) {
  EXPECT_TRUE(is_quick([&](Connection& connection) {
    connection.retry_now();
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return connection.is_connected(); }));
    connection.retry_now();
    EXPECT_TRUE(connection.is_connected()) << "an open connection stays";
  }));
}

TEST_F(WarmConnection, RetriesSlowlyIfThePeerCloses) {
  const ListeningPeer peer([](Wire&) {});
  Connection connection(loop_, peer.endpoint(), token());
  const loop::Instant began = loop_.now();
  connection.keep_warm();
  EXPECT_TRUE(
      loop::turn_until(loop_, [&] { return peer.begun() > 0 && loop_.now() - began > milliseconds(300); }));
  EXPECT_LE(peer.begun(), 1 + (loop_.now() - began) / std::chrono::seconds(1));
}

TEST_F(WarmConnection, ReconnectsAfterAnAnswerThatClosed) {
  const ListeningPeer peer(always(answer("422 No", "\"no\"")));
  Connection connection(loop_, peer.endpoint(), token());
  connection.keep_warm();
  EXPECT_EQ(answered(ask(connection, get())).status, 422);
  EXPECT_FALSE(connection.is_connected());
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return connection.is_connected(); }));
}

TEST_F(WarmConnection, RequestsDoNotWaitForARetry) {
  EXPECT_TRUE(is_quick([&](Connection& connection) {
    EXPECT_EQ(answered(ask(connection, get())).status, 200);
  })) << "it waited for the next attempt";
}

TEST_F(WarmConnection, EndsQuietly) {
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
