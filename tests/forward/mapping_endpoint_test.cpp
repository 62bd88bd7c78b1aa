// The mapping endpoint is changed while a message is under way to one that is silent: it goes to the other.
#include <gtest/gtest.h>

#include <atomic>
#include <string>

#include "../uplink/peer.hpp"
#include "forward/around.hpp"
#include "forward/delivered_scene.hpp"
#include "forward/maps.hpp"
#include "forward/telemetry.hpp"
#include "loop/turn_until.hpp"
#include "spool/messages.hpp"

namespace adit::forward {
namespace {

/// A mapping endpoint that answers, or does not.
class MappingPost {
 public:
  explicit MappingPost(bool answers, bool wants_slash = false)
      : answers_(answers), wants_slash_(wants_slash) {}
  settings::Address address() const { return {peer_.endpoint().address, peer_.endpoint().port}; }

  std::atomic<int> came = 0, redirected = 0;

 private:
  void serve(uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      const std::string redirect = wants_slash_ ? uplink::without_slash(request) : "";
      if (!redirect.empty()) {
        ++redirected;
        if (!wire.write(redirect)) return;
        continue;
      }
      ++came;
      if (answers_ && !wire.write(uplink::answer("200 OK", "null"))) return;
    }
  }
  const bool answers_, wants_slash_;
  uplink::ListeningPeer peer_{[this](uplink::Wire& wire) { serve(wire); }};
};

class MappingEndpoint : public testing::Test, protected AroundMaps {
 protected:
  MappingEndpoint() { settings_.command_post.mapping = silent_.address(); }

  /// Whether what is under way to the silent one is at the other well before that would be given up.
  template <class Sends>
  bool is_left_at_once(Sends& sends) {
    if (!loop::turn_until(loop_, [&] { return silent_.came == 1; })) return false;
    settings_.command_post.mapping = there_.address();
    sends.endpoint_changed(token_);
    return loop::turn_until(
        loop_, [&] { return there_.came == 1; }, settings_.command_post.timeouts.mapping_answer / 3);
  }

  const std::optional<icd::BearerToken> token_ = icd::BearerToken::parse("a-token");
  MappingPost silent_{false}, there_{true}, with_slash_{true, true};
};

TEST_F(MappingEndpoint, IsLeftAtOnceByAMap) {
  Maps maps(loop_, workers_, writer_, spool_, settings_, token_, record_, rejected_, random_, journal_,
            [](const icd::MapUpdate&) {});
  maps.take(spool::cloud(3), 10, nullptr, [](const icd::Checked<void>&) {});
  EXPECT_TRUE(is_left_at_once(maps));
}

TEST_F(MappingEndpoint, IsLeftAtOnceByAState) {
  DeliveredScene delivered;
  Telemetry news(loop_, workers_, settings_, token_, record_, rejected_, random_, journal_, delivered);
  ASSERT_TRUE(news.take({{.name = *icd::RobotName::parse("r1"), .pose = {}, .stamp = 1.0}}, 10));
  EXPECT_TRUE(is_left_at_once(news));
}

TEST_F(MappingEndpoint, ThatWantsASlashGetsEachMapOnceTheFirstWasRedirected) {
  settings_.command_post.mapping = with_slash_.address();
  settings_.command_post.rates.map_hz = 1000;
  Maps maps(loop_, workers_, writer_, spool_, settings_, token_, record_, rejected_, random_, journal_,
            [](const icd::MapUpdate&) {});
  for (const int arrived : {1, 2}) {
    maps.take(spool::cloud(3), 10, nullptr, [](const icd::Checked<void>&) {});
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return with_slash_.came == arrived; }));
  }
  EXPECT_EQ(with_slash_.redirected, 1);
}

TEST_F(MappingEndpoint, ThatWantsASlashGetsEachStateOnceTheFirstWasRedirected) {
  settings_.command_post.mapping = with_slash_.address();
  settings_.command_post.rates.state_hz = 1000;
  DeliveredScene delivered;
  Telemetry news(loop_, workers_, settings_, token_, record_, rejected_, random_, journal_, delivered);
  for (const int arrived : {1, 2}) {
    ASSERT_TRUE(news.take({{.name = *icd::RobotName::parse("r1"), .pose = {}, .stamp = 1.0 * arrived}}, 10));
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return with_slash_.came == arrived; }));
  }
  EXPECT_EQ(with_slash_.redirected, 1);
}

}  // namespace
}  // namespace adit::forward
