// The setting of the mapping endpoint changes while the old endpoint owes an answer.
#include <gtest/gtest.h>

#include <atomic>

#include "../uplink/peer.hpp"
#include "forward/delivered_scene.hpp"
#include "forward/fixtures.hpp"
#include "forward/telemetry.hpp"
#include "loop/turn_until.hpp"
#include "spool/messages.hpp"

namespace adit::forward {
namespace {

/// Answers each request or none.
class EndpointStub {
 public:
  explicit EndpointStub(bool answers) : answers_(answers) {}
  settings::Address address() const { return {peer_.endpoint().address, peer_.endpoint().port}; }

  std::atomic<int> came = 0;

 private:
  void serve(uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      ++came;
      if (answers_ && !wire.write(uplink::answer("200 OK", "null"))) return;
    }
  }
  const bool answers_;
  uplink::ListeningPeer peer_{[this](uplink::Wire& wire) { serve(wire); }};
};

class MappingEndpoint : public testing::Test, protected MapsParts {
 protected:
  MappingEndpoint() { settings_.command_post.mapping = silent_.address(); }

  /// True if the message in flight reaches the new endpoint long before its timeout.
  template <class Sends>
  bool is_left_at_once(Sends& sends) {
    if (!loop::turn_until(loop_, [&] { return silent_.came == 1; })) return false;
    settings_.command_post.mapping = there_.address();
    sends.on_endpoint_changed(token_);
    return loop::turn_until(
        loop_, [&] { return there_.came == 1; }, settings_.command_post.timeouts.mapping_answer / 3);
  }

  const std::optional<icd::BearerToken> token_ = icd::BearerToken::parse("a-token");
  EndpointStub silent_{false}, there_{true};
};

TEST_F(MappingEndpoint, IsLeftAtOnceByAMap) {
  Maps maps = maps_with(token_);
  maps.accept(spool::cloud(3), {.bytes = 10}, nullptr, [](const icd::Checked<void>&) {});
  EXPECT_TRUE(is_left_at_once(maps));
}

TEST_F(MappingEndpoint, IsLeftAtOnceByAState) {
  DeliveredScene delivered;
  Telemetry news(loop_, servers_, workers_, settings_, token_, counts_, rejected_, random_, journal_,
                 delivered);
  ASSERT_TRUE(news.accept({{.name = *icd::RobotName::parse("r1"), .pose = {}, .stamp = 1.0}}, 10));
  EXPECT_TRUE(is_left_at_once(news));
}

}  // namespace
}  // namespace adit::forward
