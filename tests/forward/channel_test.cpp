#include "forward/channel.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "../uplink/peer.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

class ChannelTest : public testing::Test {
 protected:
  /// The channel after one request that was answered so.
  std::unique_ptr<Channel> asked(icd::Uri uri, const std::string& answer) {
    peer_.emplace([answer](uplink::Wire& wire) { wire.read_request(), wire.write(answer); });
    auto channel = std::make_unique<Channel>(loop_, "mapping", peer_->endpoint(),
                                             icd::BearerToken::parse("a-token"), std::chrono::seconds{20});
    bool done = false;
    channel->send(uri, "", {}, [&done](const uplink::Outcome&) { done = true; });
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return done; }));
    return channel;
  }

  loop::Loop loop_;
  std::optional<uplink::ListeningPeer> peer_;
};

/// A captive portal's page has no bounds.
TEST_F(ChannelTest, KnowsAPageForNoCommandPostsHoweverLongItIs) {
  for (const char* status : {"200 OK", "302 Found", "403 Forbidden"}) {
    for (const std::size_t size : {100u, 20u << 10, 70u << 10, 1u << 20}) {
      for (const icd::Uri uri : {icd::Uri::Status, icd::Uri::MapUpdate}) {
        SCOPED_TRACE(std::string(status) + ", " + std::to_string(size));
        const auto channel = asked(uri, uplink::answer(status, "<html>" + std::string(size, 'x')));
        EXPECT_TRUE(channel->is_foreign());
        EXPECT_EQ(channel->foreign(), 1u);
        EXPECT_THAT(channel->trouble(), testing::Not(testing::IsEmpty()));
      }
    }
  }
}

TEST_F(ChannelTest, TakesTheServersOwnPageForTheCommandPosts) {
  for (const std::size_t size : {100u, 70u << 10}) {
    const auto channel =
        asked(icd::Uri::MapUpdate, uplink::answer("502 Oops", "<html>" + std::string(size, 'x')));
    EXPECT_FALSE(channel->is_foreign());
    EXPECT_NE(channel->trouble(), "");
  }
}

}  // namespace
}  // namespace adit::forward
