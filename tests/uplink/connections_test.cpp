// A second request is sent before the answer to the first, even to a server that serves one connection at a
// time, like this peer.
#include <gtest/gtest.h>

#include <mutex>
#include <semaphore>
#include <vector>

#include "asking.hpp"
#include "uplink/connection.hpp"

namespace adit::uplink {
namespace {

class TwoRequests : protected StandingTime, public Asking {
 protected:
  ~TwoRequests() override { let_.release(100); }

  /// Reads each request of a connection, and answers when allowed.
  void serve(Wire& wire) {
    while (!wire.read_request().empty()) {
      ++came_;
      let_.acquire();
      if (!wire.write(answer("200 OK", "null"))) return;
    }
  }
  void send(Request request) {
    outcomes_.emplace_back();
    connections_.send(std::move(request), [this, place = outcomes_.size() - 1](Outcome outcome) {
      outcomes_[place] = std::move(outcome);
    });
  }
  int status_of(std::size_t place) { return answered(outcomes_[place].value_or(NeverSent{"none"})).status; }
  bool is_told(std::size_t place) {
    return loop::turn_until(loop_, [&] { return outcomes_[place].has_value(); });
  }
  /// Waits until the first request has arrived and the next has a connection.
  bool one_has_arrived() {
    send(post("first"));
    connections_.preconnect();
    return loop::turn_until(loop_, [&] { return connections_.has_arrived() && connections_.is_ready(); });
  }

  std::counting_semaphore<> let_{0};
  std::atomic<int> came_ = 0;
  std::vector<std::optional<Outcome>> outcomes_;
  ListeningPeer peer_{[this](Wire& wire) { serve(wire); }};
  Connections connections_{loop_, peer_.endpoint(), token(), std::make_shared<Server>(loop_), [] {}};
};

TEST_F(TwoRequests, SecondIsServedOnceTheFirstIsAnswered) {
  ASSERT_TRUE(one_has_arrived());
  send(post(megabytes(2)));  // more than an unread connection holds
  EXPECT_FALSE(connections_.is_ready()) << "for a third";
  EXPECT_FALSE(connections_.has_arrived());
  let_.release();
  ASSERT_TRUE(is_told(0));
  EXPECT_TRUE(connections_.busy());
  let_.release();
  ASSERT_TRUE(is_told(1));
  EXPECT_EQ(status_of(0), 200);
  EXPECT_EQ(status_of(1), 200);
  EXPECT_FALSE(connections_.busy());
  EXPECT_EQ(peer_.begun(), 2);
}

/// It uses the remaining connection.
TEST_F(TwoRequests, ThirdGoesAheadOfTheSecond) {
  ASSERT_TRUE(one_has_arrived());
  send(post("second"));
  let_.release();
  ASSERT_TRUE(is_told(0));
  connections_.preconnect();
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return connections_.has_arrived() && connections_.is_ready(); }));
  send(post("third"));
  let_.release(2);
  ASSERT_TRUE(is_told(1) && is_told(2));
  EXPECT_EQ(status_of(2), 200);
  EXPECT_EQ(peer_.begun(), 3);
}

TEST_F(TwoRequests, UnusedConnectionEnds) {
  ASSERT_TRUE(one_has_arrived());
  let_.release();
  ASSERT_TRUE(is_told(0));
  EXPECT_TRUE(connections_.is_connected());
  send(post("second"));
  let_.release();
  ASSERT_TRUE(is_told(1));
  EXPECT_EQ(status_of(1), 200);
  EXPECT_EQ(peer_.begun(), 1) << "the first connection is kept";
}

TEST_F(TwoRequests, TimeoutOfTheSecondStartsAfterTheFirst) {
  constexpr std::chrono::seconds kMost{5};
  ASSERT_TRUE(one_has_arrived());
  Request second = post("second");
  second.answer_within = kMost;
  send(std::move(second));
  time.pass(2 * kMost);
  loop_.turn({});
  EXPECT_FALSE(outcomes_[1]);
  let_.release();
  ASSERT_TRUE(is_told(0));
  EXPECT_EQ(status_of(0), 200);
  EXPECT_FALSE(outcomes_[1]);
  ASSERT_TRUE(time.pass_until(loop_, [&] { return outcomes_[1].has_value(); }));
  EXPECT_THAT(why(*outcomes_[1]), testing::HasSubstr("silent for too long"));
}

TEST_F(TwoRequests, RefusedSecondConnectionLeavesOneRequest) {
  Peer closed({[this](Wire& wire) { serve(wire); }});
  Connections connections(loop_, closed.endpoint(), token(), std::make_shared<Server>(loop_), [] {});
  bool told = false;
  connections.send(post("first"), [&](const Outcome&) { told = true; });
  connections.preconnect();
  EXPECT_FALSE(connections.is_ready());
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return told; }));
  EXPECT_FALSE(connections.busy());
}

/// Otherwise each check would close and reopen a kept connection.
TEST_F(TwoRequests, SecondConnectionIsTriedOncePerRequest) {
  const ListeningPeer hangs_up({[this](Wire& wire) { serve(wire); }, [](Wire&) {}});
  Connections connections(loop_, hangs_up.endpoint(), token(), std::make_shared<Server>(loop_), [] {});
  bool told = false;
  connections.send(post("first"), [&](const Outcome&) { told = true; });
  connections.preconnect();
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return connections.has_arrived().has_value(); }));
  let_.release();
  ASSERT_TRUE(loop::turn_until(loop_, [&] {
    if (!told) connections.preconnect();
    return told;
  }));
  EXPECT_LE(hangs_up.begun(), 2);
}

}  // namespace
}  // namespace adit::uplink
