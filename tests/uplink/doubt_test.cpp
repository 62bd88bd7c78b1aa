#include <gmock/gmock.h>

#include <atomic>
#include <functional>
#include <future>
#include <string>
#include <thread>

#include "asking.hpp"

namespace adit::uplink {
namespace {

using std::chrono::milliseconds;
using testing::AllOf;
using testing::HasSubstr;

// InDoubt: bytes left, and no complete answer came.

constexpr std::string_view kSilent = "silent for too long";

struct Doubt {
  const char* name;
  Peer::Script script;
  std::string_view sentence;
};
void PrintTo(const Doubt& doubt, std::ostream* out) {
  *out << doubt.name;
}

void dribble(Wire& wire) {
  wire.read_request();
  wire.write("HTTP/1.1 200 OK\r\nX: ");
  while (wire.write("x")) std::this_thread::sleep_for(milliseconds(5));
}

void answer_of_5_megabytes(Wire& wire) {
  wire.read_request();
  wire.write("HTTP/1.1 200 OK\r\n\r\n" + std::string(5u << 20, 'x'));
}

const Doubt kDoubts[] = {
    {"silence", [](Wire& wire) { wire.wait_for_close(); }, kSilent},
    {"dribble", dribble, kSilent},
    {"half",
     [](Wire& wire) { wire.read_request(), wire.write("HTTP/1.1 200 OK\r\nContent-Length: 9\r\n\r\nhalf"); },
     "in the middle of its answer"},
    {"half_and_silence",
     [](Wire& wire) { wire.read_request(), wire.write("HTTP/1.1 200 OK\r\n"), wire.wait_for_close(); },
     kSilent},
    {"no_answer", [](Wire& wire) { wire.read_request(); }, "did not answer"},
    {"no_answer_and_not_all_read", [](Wire& wire) { wire.read_some(1); }, "Connection reset"},
    {"reset", [](Wire& wire) { wire.read_request(), wire.reset(); }, "Connection reset"},
    {"half_and_reset",
     [](Wire& wire) {
       wire.read_request(), wire.write("HTTP/1.1 200 OK\r\n\r\nwithout length");
       std::this_thread::sleep_for(milliseconds(20));
       wire.reset();
     },
     "Connection reset"},
    {"garbage",
     [](Wire& wire) { wire.read_request(), wire.write("\x16\x03\x01 what?\r\n\r\n"), wire.wait_for_close(); },
     "not HTTP"},
    {"only_interim", [](Wire& wire) { wire.read_request(), wire.write("HTTP/1.1 100 Continue\r\n\r\n"); },
     "closed the connection"},
    {"too_long", answer_of_5_megabytes, "too long"},
    {"too_long_by_its_own_word",
     [](Wire& wire) {
       wire.read_request(), wire.write("HTTP/1.1 200 OK\r\nContent-Length: 5000000\r\n\r\n");
     },
     "too long"},
};

class RequestsInDoubt : public Asking, public testing::WithParamInterface<Doubt> {};

TEST_P(RequestsInDoubt, AreSentOnceAndTellWhy) {
  const ListeningPeer peer(GetParam().script);
  Connection connection(loop_, peer.endpoint(), token());
  Request request = post("x");
  if (GetParam().sentence == kSilent) request.answer_within = milliseconds(150);
  const Outcome outcome = ask(connection, std::move(request));
  EXPECT_TRUE(std::holds_alternative<InDoubt>(outcome)) << answered(outcome).status;
  EXPECT_THAT(why(outcome), AllOf(HasSubstr("POST /map/update to 127.0.0.1:"),
                                  HasSubstr(std::string(GetParam().sentence))));
  EXPECT_FALSE(connection.is_connected());
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return peer.begun() > 0; }));
  for (int i = 0; i < 5; ++i) loop_.turn(milliseconds(2));
  EXPECT_EQ(peer.begun(), 1) << "it was sent again";
}

INSTANTIATE_TEST_SUITE_P(, RequestsInDoubt, testing::ValuesIn(kDoubts),
                         [](const auto& doubt) { return std::string(doubt.param.name); });

class DoubtfulRequests : public Asking {
 protected:
  void expect_doubt(const Peer& peer, std::string_view sentence) {
    Connection connection(loop_, peer.endpoint(), token());
    const std::string body = megabytes(20);
    const Outcome outcome = ask(connection, post(body));
    EXPECT_TRUE(std::holds_alternative<InDoubt>(outcome)) << answered(outcome).status;
    EXPECT_THAT(why(outcome), HasSubstr(std::string(sentence)));
    EXPECT_LT(connection.sent_bytes(), body.size());
  }
};

TEST_F(DoubtfulRequests, HaveAPeerThatDribblesWithoutReading) {
  const ListeningPeer peer([](Wire& wire) {
    wire.read_some(1);
    for (int i = 0; i < 200 && wire.write("H"); ++i) std::this_thread::sleep_for(milliseconds(5));
  });
  Connection connection(loop_, peer.endpoint(), token());
  Request request = post(megabytes(20));
  request.answer_within = milliseconds(200);
  EXPECT_TRUE(std::holds_alternative<InDoubt>(ask(connection, std::move(request))));
}

TEST_F(DoubtfulRequests, WereResetHalfWay) {
  const ListeningPeer peer([](Wire& wire) { wire.read_some(1 << 16), wire.reset(); });
  expect_doubt(peer, "");
}

TEST_F(DoubtfulRequests, HaveAnEarlyAnswerThatEndsInAReset) {
  const ListeningPeer peer([](Wire& wire) {
    wire.read_head();
    wire.write("HTTP/1.1 400 Bad Request\r\n\r\nthis has no length, and its end ");
    std::this_thread::sleep_for(milliseconds(20));
    wire.reset();
  });
  expect_doubt(peer, "");
}

/// A 2xx counts only for a whole request.
TEST_F(DoubtfulRequests, WereAcceptedHalfWayAndReset) {
  const ListeningPeer peer([](Wire& wire) {
    wire.read_some(1 << 16);
    wire.write(answer("200 OK", "null"));
  });
  expect_doubt(peer, "answered 200 before");
}

/// The sending kernel has all bytes, the receiving one has not.
TEST_F(DoubtfulRequests, WereAcceptedBeforeTheyArrived) {
  std::promise<void> has_left;
  Peer peer({[&has_left](Wire& wire) {
    wire.read_head();
    has_left.get_future().wait();
    wire.write(answer("200 OK", "null"));
  }});
  peer.hold(8 * 1024);
  peer.listen();
  Connection connection(loop_, peer.endpoint(), token());
  const std::string body(40'000, 'x');
  std::optional<Outcome> outcome;
  connection.send(post(body), [&](Outcome got) { outcome = std::move(got); });
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return connection.sent_bytes() > body.size(); }))
      << connection.sent_bytes();
  EXPECT_FALSE(connection.has_arrived());
  has_left.set_value();
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return outcome.has_value(); }));
  EXPECT_TRUE(std::holds_alternative<InDoubt>(*outcome)) << answered(*outcome).status;
  EXPECT_THAT(why(*outcome), HasSubstr("answered 200 before"));
}

/// Large requests to a peer that reads their beginning at most.
class UnreadRequests : protected StandingTime, public Asking {
 protected:
  /// `begin` reads and writes. The peer then waits for the end.
  void expect_silence(const Peer::Script& begin) {
    std::promise<void> over;
    std::atomic<bool> has_begun = false;
    const ListeningPeer peer([&](Wire& wire) {
      begin(wire);
      has_begun = true;
      over.get_future().wait();
    });
    Connection connection(loop_, peer.endpoint(), token());
    Outcome outcome;
    connection.send(post(megabytes(20)), [&](Outcome got) { outcome = std::move(got); });
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return has_begun.load(); }));
    EXPECT_TRUE(loop::turn_until(loop_, [&] {
      time.pass(kPatience / 20);
      return !connection.busy();
    }));
    over.set_value();
    EXPECT_TRUE(std::holds_alternative<InDoubt>(outcome)) << answered(outcome).status;
    EXPECT_THAT(why(outcome), HasSubstr(std::string(kSilent)));
  }
};

TEST_F(UnreadRequests, HaveAPeerThatNeverReads) {
  expect_silence([](Wire&) {});
}

TEST_F(UnreadRequests, WereAcceptedHalfWay) {
  expect_silence([](Wire& wire) {
    wire.read_head();
    wire.write(answer("200 OK", "null"));
  });
}

/// Whether a connection ended with a reset for the peer, after `use` used and left it.
class ConnectionEnds : public Asking {
 protected:
  bool was_reset(const Peer::Script& script, const std::function<void(Connection&)>& use) {
    bool reset = false;
    {
      const ListeningPeer peer([&](Wire& wire) {
        script(wire);
        wire.wait_for_close();
        reset = wire.was_reset();
      });
      Connection connection(loop_, peer.endpoint(), token());
      use(connection);
    }
    return reset;
  }
};

TEST_F(ConnectionEnds, ResetARequestInDoubt) {
  const auto deaf = [](Wire&) { std::this_thread::sleep_for(milliseconds(400)); };
  for (const std::string& body : {std::string("a report"), megabytes(1)}) {
    EXPECT_TRUE(was_reset(deaf, [&](Connection& connection) {
      Request request = post(body);
      request.answer_within = milliseconds(100);
      EXPECT_TRUE(std::holds_alternative<InDoubt>(ask(connection, std::move(request))));
    }));
  }
}

TEST_F(ConnectionEnds, ResetAnAbandonedRequest) {
  std::atomic<bool> came = false;
  const auto silent = [&](Wire& wire) { wire.read_request(), came = true; };
  EXPECT_TRUE(was_reset(silent, [&](Connection& connection) {
    connection.send(post("a report"), [](const Outcome&) { ADD_FAILURE() << "done was called"; });
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return came.load(); }));
  }));
}

TEST_F(ConnectionEnds, AreOrderlyAfterAnAnswer) {
  for (const char* field : {"", "Connection: close\r\n"}) {
    const auto answers = [&](Wire& wire) {
      wire.read_request();
      wire.write(std::string("HTTP/1.1 200 OK\r\nContent-Length: 0\r\n") + field + "\r\n");
    };
    EXPECT_FALSE(was_reset(answers, [&](Connection& connection) {
      EXPECT_EQ(answered(ask(connection, post("a report"))).status, 200);
    }));
  }
}

TEST_F(DoubtfulRequests, WereOnAKeptConnectionClosedUnanswered) {
  const ListeningPeer peer([](Wire& wire) {
    wire.read_request();
    wire.write(answer("200 OK", "null"));
    wire.read_request();  // it arrived, and its outcome is unknown
  });
  Connection connection(loop_, peer.endpoint(), token());
  EXPECT_EQ(answered(ask(connection, get())).status, 200);
  const Outcome outcome = ask(connection, post("a report"));
  EXPECT_TRUE(std::holds_alternative<InDoubt>(outcome)) << why(outcome);
  for (int i = 0; i < 5; ++i) loop_.turn(milliseconds(2));
  EXPECT_EQ(peer.begun(), 1) << "it was sent again";
}

}  // namespace
}  // namespace adit::uplink
