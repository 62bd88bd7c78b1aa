#include <gtest/gtest.h>

#include <ctime>

#include "../uplink/peer.hpp"
#include "box/self_test.hpp"
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

/// CoSTAR's stand-in for the Command Post has a web page at paths without a slash, and never redirects.
TEST(EndpointTest, TriesASlashIfTheStatusIsAWebPage) {
  const std::string run =
      R"({"score": 1, "run_clock": 2.5, "remaining_reports": 44, "current_team": "subt"})";
  for (const bool is_stand_in : {true, false}) {
    loop::SimulatedTime time;
    loop::Loop loop;
    uplink::ListeningPeer peer([&](uplink::Wire& wire) {
      const bool has_slash = wire.read_request().starts_with("GET /api/status/ ");
      wire.write(!has_slash    ? uplink::answer("200 OK", "<html>")
                 : is_stand_in ? uplink::answer("200 OK", run)
                               : uplink::answer("404 Not Found", "<html>"));
    });
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
    EXPECT_EQ(step->state, is_stand_in ? "good" : "bad") << step->said;
    EXPECT_TRUE(step->said.contains(is_stand_in ? "slash" : "200")) << step->said;
  }
}

}  // namespace
}  // namespace adit::box
