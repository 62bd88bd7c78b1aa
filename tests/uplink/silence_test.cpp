// How long the peer is silent, at times that the test makes up.
#include <gtest/gtest.h>

#include "asking.hpp"
#include "uplink/exchange.hpp"

namespace adit::uplink {
namespace {

using std::chrono::milliseconds;

class Silence : public Asking {
 protected:
  static constexpr milliseconds kMost{10'000};

  /// Begins a request to a peer that reads all bytes. Returns whether the kernel has connected.
  bool begin(Request request) {
    request.answer_within = kMost;
    exchange_.emplace(peer_.endpoint(), token(), std::move(request));
    auto made = begin_connect(peer_.endpoint());
    if (!made) return false;
    fd_ = std::move(*made);
    exchange_->begin(now_, 0);
    return more_arrives();
  }
  std::size_t arrived() const {
    return exchange_->sent_bytes() - std::min(exchange_->sent_bytes(), unacknowledged_bytes(fd_.get()));
  }
  /// Writes until the peer's kernel has acknowledged more bytes.
  bool more_arrives() {
    const std::size_t before = arrived();
    return loop::turn_until(loop_, [&] {
      if (exchange_->wants_to_write()) exchange_->write(fd_.get());
      return arrived() > before;
    });
  }
  bool all_arrives() {
    return loop::turn_until(loop_, [&] { return unacknowledged_bytes(fd_.get()) == 0; });
  }
  bool is_silent_after(milliseconds pause) {
    now_ += pause;
    exchange_->listen(fd_.get(), now_);
    return exchange_->is_silent_at(now_);
  }

  const ListeningPeer peer_{[](Wire& wire) { wire.wait_for_close(); }};
  loop::FileDescriptor fd_;
  loop::Instant now_{std::chrono::hours(1)};
  std::optional<Exchange> exchange_;
};

TEST_F(Silence, EndsWithEachByteThatArrives) {
  ASSERT_TRUE(begin(post(megabytes(20))));
  while (exchange_->wants_to_write()) {
    ASSERT_FALSE(is_silent_after(kMost * 9 / 10)) << arrived();
    ASSERT_TRUE(more_arrives());
  }
  ASSERT_TRUE(all_arrives());
  EXPECT_FALSE(is_silent_after(kMost * 9 / 10));
  EXPECT_TRUE(is_silent_after(kMost)) << "no more bytes";
}

TEST_F(Silence, DoesNotCountWhileBytesAreHeldBack) {
  Request request = post("body");
  request.last_byte_not_before = now_ + 3 * kMost;
  ASSERT_TRUE(begin(std::move(request)) && all_arrives());
  EXPECT_FALSE(is_silent_after(kMost));
  EXPECT_FALSE(is_silent_after(kMost));
  EXPECT_FALSE(is_silent_after(kMost));
  EXPECT_TRUE(exchange_->release(now_));
  EXPECT_TRUE(is_silent_after(kMost)) << "the rest does not arrive";
}

TEST_F(Silence, DoesNotCountUntilTheEarlierRequestHasEnded) {
  Request request = post("second");
  request.goes_ahead = true;
  ASSERT_TRUE(begin(std::move(request)) && all_arrives());
  EXPECT_FALSE(is_silent_after(kMost));
  EXPECT_FALSE(is_silent_after(kMost));
  exchange_->on_earlier_request_ended(now_ += kMost / 2);
  EXPECT_FALSE(is_silent_after(kMost * 9 / 10));
  EXPECT_TRUE(is_silent_after(kMost / 10));
}

}  // namespace
}  // namespace adit::uplink
