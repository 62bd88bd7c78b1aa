#include "box/endpoint_test.hpp"

#include <gtest/gtest.h>

#include <ctime>

#include "../uplink/peer.hpp"
#include "loop/simulated_time.hpp"

namespace adit::box {
namespace {

/// "Sun, 06 Nov 1994 08:49:37 GMT" (RFC 9110 5.6.7).
std::string http_date(double seconds) {
  const auto time = static_cast<std::time_t>(seconds);
  std::tm parts{};
  char text[64];
  const std::size_t length =
      std::strftime(text, sizeof text, "%a, %d %b %Y %H:%M:%S GMT", ::gmtime_r(&time, &parts));
  return {text, length};
}

TEST(EndpointTest, ComparesADateWithTheTimeOfItsOwnAnswer) {
  loop::SimulatedTime time;
  loop::Loop loop;
  uplink::ListeningPeer peer(
      {[date = http_date(loop.wall_now())](uplink::Wire& wire) {
         wire.read_request();
         wire.write(uplink::answer("429 Too Many Requests", "\"too many\"", "Date: " + date + "\r\n"));
       },
       [](uplink::Wire& wire) { wire.wait_for_close(); }});
  TestTarget tried{.post = {}, .scoring = icd::BearerToken::parse("typed"), .mapping = {}};
  tried.post.interface = "";
  tried.post.scoring = {peer.endpoint().address, peer.endpoint().port};
  const EndpointTest::Turns turns;
  const settings::CommandPost in_use;
  std::optional<api::TestStep> step;
  EndpointTest test(loop, turns, in_use, tried, steps::Asked::Scoring,
                    [&](api::TestStep each) { step = std::move(each); });

  test.check_token();
  ASSERT_TRUE(time.pass_until(loop, [&] { return step.has_value(); }));
  EXPECT_EQ(step->state, "bad") << "the second request has no answer: " << step->said;
  test.check_clock();
  EXPECT_EQ(step->state, "good") << step->said;
}

}  // namespace
}  // namespace adit::box
