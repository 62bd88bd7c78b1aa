// The last bytes of a request may be held back. Its answer says when they left.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "asking.hpp"

namespace adit::uplink {
namespace {

using std::chrono::milliseconds;

class HeldBackByte : public Asking {
 protected:
  Peer::Script answers_after(milliseconds pause) {
    return [this, pause](Wire& wire) {
      wire.read_request();
      whole_ = loop_.now();
      std::this_thread::sleep_for(pause);
      wire.write(answer("200 OK", "null"));
    };
  }

  std::atomic<loop::Instant> whole_ = loop::Instant{};
};

TEST_F(HeldBackByte, AllButALittleLeavesAtOnce) {
  const ListeningPeer peer(answers_after({}));
  Connection connection(loop_, peer.endpoint(), token());
  const std::string body = megabytes(3);
  Request request = post(body);
  request.last_byte_not_before = loop_.now() + std::chrono::hours(1);
  connection.send(std::move(request), [](const Outcome&) { ADD_FAILURE() << "it was answered"; });
  const std::size_t most = body.size() - Request::kHeldBack;
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return connection.sent_bytes() > most; }));
  for (int i = 0; i < 5; ++i) loop_.turn(milliseconds(2));
  EXPECT_LT(connection.sent_bytes(), body.size());
}

TEST_F(HeldBackByte, LastByteIsNotSentEarly) {
  for (const std::size_t size : {0u, 1u, 1024u, 300'000u}) {
    const ListeningPeer peer(answers_after({}));
    Request request = post(std::string(size, 'x'));
    const loop::Instant not_before = loop_.now() + milliseconds(100);
    request.last_byte_not_before = not_before;
    const Answered got = answered(ask(peer.endpoint(), std::move(request)));
    EXPECT_EQ(got.status, 200) << got.body;
    if (size == 0) continue;  // a head alone is not held back
    EXPECT_GE(whole_.load(), not_before) << size;
    EXPECT_GE(got.sent.last, not_before) << size;
    EXPECT_LE(got.sent.first, got.sent.last) << size;
  }
}

/// If the kernel had to retransmit, the answer's time counts, because the true time is unknown; then the
/// test repeats. On a busy machine that happens with nearly each large body, so this one is small.
TEST_F(HeldBackByte, SendTimeOfTheLastByteIsNotTheAnswerTime) {
  for (int tries = 0; tries < 10; ++tries) {
    const ListeningPeer peer(answers_after(milliseconds(400)));
    const loop::Instant begin = loop_.now();
    const Answered got = answered(ask(peer.endpoint(), post("body")));
    EXPECT_EQ(got.status, 200);
    EXPECT_GE(got.sent.first, begin);
    EXPECT_LE(got.sent.first, got.sent.last);
    if (got.sent.last < loop_.now() - milliseconds(200)) return;
  }
  FAIL() << "ten times";
}

}  // namespace
}  // namespace adit::uplink
