// Servers that serve one connection at a time, like this peer, and others.
#include <gmock/gmock.h>

#include <mutex>
#include <semaphore>
#include <vector>

#include "asking.hpp"
#include "uplink/connection.hpp"

namespace adit::uplink {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;

class ServerTest : protected StandingTime, public Asking {
 protected:
  ServerTest() {
    peer_.emplace(std::vector<Peer::Script>{[this](Wire& wire) { serve(wire); }});
  }
  ~ServerTest() override { holds_ = false, let_.release(100); }

  void listen(bool all_at_once = false) {
    if (all_at_once) peer_->serve_all_at_once();
    peer_->listen();
    for (int i = 0; i < 3; ++i)
      connections_.push_back(
          std::make_unique<Connection>(loop_, peer_->endpoint(), token(), servers_.at(peer_->endpoint())));
  }
  /// Answers at once, or when allowed.
  void serve(Wire& wire) {
    for (std::string request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      const bool holds = holds_;
      {
        const std::lock_guard lock(mutex_);
        received_ += request[request.find('/') + 1];
      }
      if (holds) let_.acquire();
      if (!wire.write(answer("200 OK", "null")) || closes_) return;
    }
  }
  std::string received() {
    const std::lock_guard lock(mutex_);
    return received_;
  }
  bool has_received(const std::string& all) {
    return loop::turn_until(loop_, [&] { return received() == all; });
  }
  void send(std::size_t place, Request request) {
    outcomes_[place].reset();
    connections_[place]->send(std::move(request),
                              [this, place](Outcome outcome) { outcomes_[place] = std::move(outcome); });
  }
  int status_of(std::size_t place) { return outcomes_[place] ? answered(*outcomes_[place]).status : -1; }
  bool is_answered(std::size_t place) {
    return loop::turn_until(loop_, [&] { return outcomes_[place].has_value(); }) && status_of(place) == 200;
  }
  /// Lets time pass until the idle connection is closed, and none while the peer's thread answers.
  bool is_answered_after_closing(std::size_t idle, std::size_t place) {
    return time.pass_until(loop_, [&] { return !connections_[idle]->is_connected(); }) && is_answered(place);
  }
  void learn() {
    send(0, get("/a"));
    ASSERT_TRUE(is_answered(0));
    for (const std::size_t place : {1u, 0u}) {
      send(place, get("/a"));
      ASSERT_TRUE(is_answered_after_closing(1 - place, place));
    }
    ASSERT_TRUE(server().is_serial());
    const std::lock_guard lock(mutex_);
    received_.clear();
  }
  /// The answer takes 1.5 s.
  void ask_slowly(std::size_t place) {
    holds_ = true;
    const std::size_t before = received().size();
    send(place, get("/slow"));
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return received().size() > before; }));
    time.pass(loop_, milliseconds(1500));
    holds_ = false, let_.release();
    ASSERT_TRUE(is_answered(place));
  }
  Server& server() { return *servers_.at(peer_->endpoint()); }

  std::mutex mutex_;
  std::string received_;
  std::atomic<bool> holds_ = false, closes_ = false;
  std::counting_semaphore<> let_{0};
  std::optional<Peer> peer_;
  Servers servers_{loop_};
  std::array<std::optional<Outcome>, 3> outcomes_;
  std::vector<std::unique_ptr<Connection>> connections_;
};

TEST_F(ServerTest, IdleConnectionIsClosedAfterASecondWithoutAnAnswer) {
  listen();
  send(0, get());
  ASSERT_TRUE(is_answered(0));
  send(1, post(megabytes(2)));  // more than an unread connection holds
  const loop::Instant sent = loop_.now();
  EXPECT_TRUE(is_answered_after_closing(0, 1));
  EXPECT_GE(loop_.now() - sent, Server::kSilence);
  EXPECT_FALSE(connections_[0]->is_connected());
}

TEST_F(ServerTest, WarmConnectionIsClosed) {
  listen();
  connections_[0]->keep_warm();
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return peer_->begun() == 1; }));
  send(1, get());
  EXPECT_TRUE(is_answered_after_closing(0, 1));
}

TEST_F(ServerTest, SerialServerGetsOneConnectionAtATime) {
  listen();
  learn();
  connections_[0]->keep_warm();
  for (int i = 0; i < 3; ++i) {
    for (const std::size_t place : {0u, 1u, 2u}) {
      send(place, get("/a"));
      EXPECT_TRUE(is_answered(place));
      EXPECT_FALSE(connections_[place]->is_connected());
    }
  }
  EXPECT_EQ(received(), "aaaaaaaaa");
}

/// Each turn sends one request, named by its letter.
class TurnsTest : public ServerTest {
 protected:
  TurnsTest() {
    for (Server::Turn& each : turns_) each.on_turn = [this, &each] { came(each); };
  }
  ~TurnsTest() override {
    for (Server::Turn& each : turns_) server_->remove(each);
  }
  /// The first turn has a request in flight.
  void begin() {
    listen();
    learn();
    server_ = servers_.at(peer_->endpoint());
    for (Server::Turn& each : turns_) server_->add(each);
    holds_ = true;
    came(turns_[0]);
    ASSERT_TRUE(has_received("a"));
  }
  void came(Server::Turn& turn) {
    const auto place = static_cast<std::size_t>(&turn - turns_.data());
    if (has_nothing_[place] || !server_->claim(turn, goes_first_[place])) return;
    send(place, get(std::string("/") + "abc"[place]));
  }

  std::array<Server::Turn, 3> turns_;
  std::array<bool, 3> goes_first_{}, has_nothing_{};
  std::shared_ptr<Server> server_ = servers_.at(Endpoint());
};

TEST_F(TurnsTest, SenderWhoseTurnWasLongestAgoIsNext) {
  begin();
  came(turns_[1]);
  let_.release();
  ASSERT_TRUE(has_received("ab"));
  came(turns_[0]);
  came(turns_[2]);
  let_.release();
  EXPECT_TRUE(has_received("abc"));
  let_.release();
  EXPECT_TRUE(has_received("abca"));
}

TEST_F(TurnsTest, ReportGoesFirst) {
  begin();
  goes_first_[2] = true;
  came(turns_[1]);
  came(turns_[2]);
  let_.release();
  ASSERT_TRUE(has_received("ac"));
  time.pass(milliseconds(1));
  came(turns_[0]);
  let_.release();
  EXPECT_TRUE(has_received("acb"));
  let_.release();
  EXPECT_TRUE(has_received("acba"));
}

TEST_F(TurnsTest, NextSenderIsAskedIfTheFirstHasNothingLeft) {
  begin();
  goes_first_[2] = true;
  came(turns_[1]);
  came(turns_[2]);
  has_nothing_[2] = true;
  let_.release();
  EXPECT_TRUE(has_received("ab"));
}

TEST_F(TurnsTest, NextSenderIsAskedIfTheFirstSendsNothing) {
  begin();
  came(turns_[1]);
  let_.release();
  ASSERT_TRUE(is_answered(0));
  has_nothing_[1] = true;
  EXPECT_TRUE(server_->claim(turns_[2], true)) << "and sends nothing";
  has_nothing_[1] = false;
  EXPECT_TRUE(has_received("ab"));
}

TEST_F(TurnsTest, RemovedTurnNeverComes) {
  begin();
  came(turns_[2]);
  server_->remove(turns_[2]);
  came(turns_[1]);
  let_.release();
  EXPECT_TRUE(has_received("ab"));
}

TEST_F(TurnsTest, AllComeIfSeveralConnectionsAreTriedAgain) {
  begin();
  came(turns_[1]);
  came(turns_[2]);
  time.pass(Server::kTryAgain);
  EXPECT_TRUE(loop::turn_until(
      loop_, [&] { return connections_[1]->is_connected() && connections_[2]->is_connected(); }));
}

TEST_F(ServerTest, SerialServerIsTriedAgain) {
  listen();
  learn();
  connections_[0]->keep_warm();
  send(1, get("/a"));
  ASSERT_TRUE(is_answered(1));
  time.pass(Server::kTryAgain);
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return connections_[0]->is_connected(); }));
  EXPECT_FALSE(server().is_serial());
}

/// A report in flight is never closed for another request.
TEST_F(ServerTest, RequestInFlightIsNotClosed) {
  listen();
  holds_ = true;
  send(0, get("/a"));
  ASSERT_TRUE(has_received("a"));
  send(1, get("/b"));
  time.pass(loop_, 3 * Server::kSilence);
  let_.release(2);
  EXPECT_TRUE(is_answered(0));
  EXPECT_TRUE(is_answered(1));
  EXPECT_EQ(received(), "ab");
  EXPECT_FALSE(connections_[0]->is_connected()) << "it blocked the other one";
}

TEST_F(ServerTest, WarmConnectionsReturnIfThatDidNotHelp) {
  listen(true);
  connections_[0]->keep_warm();
  send(0, get("/a"));
  ASSERT_TRUE(is_answered(0));
  holds_ = true;
  send(1, get("/b"));
  ASSERT_TRUE(has_received("ab"));
  time.pass(loop_, Server::kSilence + milliseconds(300));
  EXPECT_FALSE(connections_[0]->is_connected());
  time.pass(Server::kSilence);
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return connections_[0]->is_connected(); }));
  let_.release();
  EXPECT_TRUE(is_answered(1));
  EXPECT_TRUE(connections_[0]->is_connected());
  EXPECT_FALSE(server().is_serial());
}

TEST_F(ServerTest, SlowServerIsNotSerial) {
  listen(true);
  for (int i = 0; i < 4; ++i) {
    send(0, get("/a"));
    ASSERT_TRUE(is_answered(0));
    ask_slowly(1);
    EXPECT_EQ(connections_[0]->is_connected(), i > 0) << "a known connection cannot be blocked";
  }
  EXPECT_FALSE(server().is_serial());
}

TEST_F(ServerTest, AnAnswerThatPassesAnOpenConnectionShowsThatItBlocksNone) {
  for (const bool passes : {true, false}) {
    peer_.emplace(std::vector<Peer::Script>{[this](Wire& wire) { serve(wire); }});
    connections_.clear();
    listen(true);
    send(0, get("/a"));
    ASSERT_TRUE(is_answered(0));
    ask_slowly(1);
    time.pass(milliseconds(1));
    if (passes) {
      send(2, get("/c"));
      ASSERT_TRUE(is_answered(2));
    }
    ask_slowly(0);
    EXPECT_EQ(server().is_serial(), !passes);
  }
}

/// As Python's http.server does with HTTP/1.0: the connection that Adit opens for the next request blocks
/// all.
TEST_F(ServerTest, ServerThatClosesAfterEachAnswerIsSerial) {
  closes_ = true;
  listen();
  connections_[0]->keep_warm();
  for (int i = 1; i <= 2; ++i) {
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return connections_[0]->is_connected(); }));
    EXPECT_FALSE(server().is_serial());
    time.pass(milliseconds(1));
    send(1, get("/a"));
    ASSERT_TRUE(is_answered_after_closing(0, 1));
    time.pass(Server::kSilence);
  }
  EXPECT_TRUE(server().is_serial());
  send(1, get("/b"));
  EXPECT_TRUE(is_answered(1));
}

TEST_F(ServerTest, SlowServerBesideAWarmConnectionIsNotSerial) {
  closes_ = true;
  listen(true);
  connections_[0]->keep_warm();
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return connections_[0]->is_connected(); }));
    time.pass(milliseconds(1));
    ask_slowly(1);
    time.pass(Server::kSilence);
  }
  EXPECT_FALSE(server().is_serial());
}

TEST_F(ServerTest, IsTheSameForOneAddressAndPort) {
  Endpoint here;
  here.address = "10.100.1.200";
  here.port = 8000;
  Endpoint there = here;
  const auto server = servers_.at(here);
  EXPECT_EQ(servers_.at(here), server);
  there.port = 8001;
  EXPECT_NE(servers_.at(there), server);
  there = here, there.address = "10.100.1.201";
  EXPECT_NE(servers_.at(there), server);
}

}  // namespace
}  // namespace adit::uplink
