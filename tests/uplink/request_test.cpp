#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

#include "asking.hpp"

namespace adit::uplink {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class ConnectionRequests : public Asking {};

/// Keeps the one request that it is asked, and answers it.
struct Listener {
  std::string request;
  Peer::Script script() {
    return [this](Wire& wire) {
      request = wire.read_request();
      wire.write(answer("200 OK", "null"));
    };
  }
};

TEST_F(ConnectionRequests, AreInTheFormThatServersAccept) {
  Listener listener;
  std::string authority;
  {
    const ListeningPeer peer(listener.script());
    authority = "127.0.0.1:" + std::to_string(peer.endpoint().port);
    const Answered got = answered(ask(peer.endpoint(), post("body")));
    EXPECT_EQ(got.status, 200);
    EXPECT_EQ(got.body, "null");
  }
  EXPECT_EQ(listener.request,
            "POST /map/update HTTP/1.1\r\nHost: " + authority + "\r\nAuthorization: Bearer " + kToken +
                "\r\nUser-Agent: adit/0.1.0\r\nAccept: application/json\r\nAccept-Encoding: identity\r\n"
                "Content-Type: application/cbor\r\nContent-Length: 4\r\n\r\nbody");
}

TEST_F(ConnectionRequests, HaveNoLengthWithoutABody) {
  Listener listener;
  {
    const ListeningPeer peer(listener.script());
    EXPECT_EQ(answered(ask(peer.endpoint(), get())).status, 200);
  }
  EXPECT_THAT(listener.request, StartsWith("GET /api/status HTTP/1.1\r\n"));
  EXPECT_THAT(listener.request, Not(HasSubstr("Content-")));
}

TEST_F(ConnectionRequests, OfAnEmptyPostHaveLengthZero) {
  Listener listener;
  {
    const ListeningPeer peer(listener.script());
    EXPECT_EQ(answered(ask(peer.endpoint(), post(""))).status, 200);
  }
  EXPECT_THAT(listener.request, HasSubstr("\r\nContent-Length: 0\r\n"));
}

TEST_F(ConnectionRequests, ArriveUnchangedInAnyPieces) {
  const std::string all = megabytes(5);
  icd::ChunkedBytes body;
  for (std::size_t at = 0, size = 1; at < all.size(); size = size * 3 + 1) {  // chunks of many sizes
    const std::size_t piece = std::min({size, all.size() - at, std::size_t{64} << 10});
    body.append(std::vector<std::uint8_t>(all.begin() + static_cast<std::ptrdiff_t>(at),
                                          all.begin() + static_cast<std::ptrdiff_t>(at + piece)));
    at += piece;
  }
  for (const std::uint64_t pace : {0, 500'000'000}) {
    Request request = post("");
    request.body = body;
    Listener listener;
    std::size_t sent = 0;
    {
      const ListeningPeer peer(listener.script());
      Endpoint endpoint = peer.endpoint();
      endpoint.bytes_per_second = pace;
      Connection connection(loop_, endpoint, token());
      EXPECT_EQ(answered(ask(connection, std::move(request))).status, 200);
      sent = connection.sent_bytes();
    }
    EXPECT_EQ(sent, listener.request.size());
    EXPECT_TRUE(listener.request.ends_with(all)) << pace;
  }
}

TEST_F(ConnectionRequests, FollowEachOtherOnOneConnection) {
  const ListeningPeer peer(always(answer("200 OK", "null")));
  Connection connection(loop_, peer.endpoint(), token());
  for (int i = 0; i < 20; ++i) EXPECT_EQ(answered(ask(connection, post("x"))).status, 200);
  EXPECT_EQ(peer.begun(), 1);
  EXPECT_TRUE(connection.is_connected());
}

TEST_F(ConnectionRequests, ReconnectAfterAnAnswerThatClosed) {
  const std::string endings[] = {answer("200 OK", "null", "Connection: close\r\n"),
                                 "HTTP/1.0 200 OK\r\nContent-Length: 4\r\n\r\nnull",
                                 answer("429 Too Many Requests", "\"slow\""),
                                 answer("500 Internal Server Error", "<html>"),
                                 answer("200 OK", "null") + "and more",
                                 "HTTP/1.1 200 OK\r\n\r\nuntil the end"};
  for (const auto& ending : endings) {
    SCOPED_TRACE(ending);
    const ListeningPeer peer([&](Wire& wire) {
      wire.read_request();
      wire.write(ending);
      if (ending.ends_with("the end")) return;
      wire.wait_for_close();  // though the peer would keep it
    });
    Connection connection(loop_, peer.endpoint(), token());
    const Answered first = answered(ask(connection, get()));
    EXPECT_FALSE(connection.is_connected());
    const Answered second = answered(ask(connection, get()));
    EXPECT_GE(first.status, 200);
    EXPECT_EQ(first.status, second.status);
    EXPECT_EQ(peer.begun(), 2);
  }
}

TEST_F(ConnectionRequests, CanBeSentFromACompletion) {
  const ListeningPeer peer(always(answer("200 OK", "null")));
  Connection connection(loop_, peer.endpoint(), token());
  int answers = 0;
  std::function<void(Outcome)> next = [&](const Outcome& outcome) {
    EXPECT_EQ(answered(outcome).status, 200);
    if (++answers < 5) connection.send(get(), next);
  };
  connection.send(get(), next);
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return answers == 5; }));
}

TEST_F(ConnectionRequests, MayDestroyTheirConnectionInACompletion) {
  const auto destroy_in_done = [&](const Endpoint& endpoint, Request request) {
    auto connection = std::make_unique<Connection>(loop_, endpoint, token());
    connection->keep_warm();
    int calls = 0;
    connection->send(std::move(request), [&, kept = std::string(100, 'k')](const Outcome&) {
      connection.reset();
      calls += kept.size() == 100 ? 1 : 100;  // the callback itself still lives
    });
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return calls > 0; }));
    for (int i = 0; i < 3; ++i) loop_.turn(std::chrono::milliseconds(1));
    EXPECT_EQ(calls, 1);
  };
  const ListeningPeer answers(always(answer("200 OK", "null")));
  destroy_in_done(answers.endpoint(), get());
  const ListeningPeer refuses(always(answer("422 No", "\"no\"")));
  destroy_in_done(refuses.endpoint(), get());
  const ListeningPeer resets([](Wire& wire) { wire.read_head(), wire.reset(); });
  destroy_in_done(resets.endpoint(), get());
  Endpoint nowhere = answers.endpoint();
  nowhere.interface = "absent0";
  destroy_in_done(nowhere, get());
  const ListeningPeer silent([](Wire& wire) { wire.wait_for_close(); });
  Request impatient = get();
  impatient.answer_within = std::chrono::milliseconds(30);
  destroy_in_done(silent.endpoint(), std::move(impatient));
}

TEST_F(ConnectionRequests, AreNotCompletedOnceTheirConnectionIsGone) {
  const ListeningPeer peer(
      [](Wire& wire) { wire.read_head(), wire.write("HTTP/1.1 20"), wire.wait_for_close(); });
  for (int turns = 0; turns < 12; ++turns) {  // connecting, sending, waiting, reading
    {
      Connection connection(loop_, peer.endpoint(), token());
      connection.send(post(megabytes(1)), [&](const Outcome&) { ADD_FAILURE() << "done was called"; });
      for (int i = 0; i < turns; ++i) loop_.turn(std::chrono::milliseconds(1));
    }
    for (int i = 0; i < 3; ++i) loop_.turn(std::chrono::milliseconds(1));
  }
}

TEST_F(ConnectionRequests, AlsoUseIpv6) {
  Listener listener;
  try {
    const ListeningPeer peer(std::vector{listener.script()}, "::1");
    const auto port = std::to_string(peer.endpoint().port);
    EXPECT_EQ(answered(ask(peer.endpoint(), get())).status, 200);
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return peer.ended() > 0; }));
    EXPECT_THAT(listener.request, HasSubstr("\r\nHost: [::1]:" + port + "\r\n"));
  } catch (const std::runtime_error& error) {
    GTEST_SKIP() << "no IPv6 here: " << error.what();
  }
}

TEST_F(ConnectionRequests, UseTheBoundInterface) {
  const ListeningPeer peer(always(answer("200 OK", "null")));
  Endpoint endpoint = peer.endpoint();
  endpoint.interface = "lo";
  const Outcome outcome = ask(endpoint, get());
  EXPECT_EQ(answered(outcome).status, 200) << why(outcome);
}

}  // namespace
}  // namespace adit::uplink
