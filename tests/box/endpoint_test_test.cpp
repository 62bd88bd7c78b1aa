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
  std::optional<api::TestStep> step;
  EndpointTest test(loop, turns, tried, steps::EndpointKind::Scoring,
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
    std::optional<api::TestStep> step;
    EndpointTest test(loop, turns, tried, steps::EndpointKind::Scoring,
                      [&](api::TestStep each) { step = std::move(each); });
    test.check_token();
    ASSERT_TRUE(time.pass_until(loop, [&] { return step.has_value(); }));
    EXPECT_EQ(step->state, is_stand_in ? "good" : "bad") << step->said;
    EXPECT_TRUE(step->said.contains(is_stand_in ? "slash" : "200")) << step->said;
  }
}

/// The answers of real mapping servers to an unknown path, and of servers that answer all paths alike.
TEST(EndpointTest, TellsAMappingEndpointByItsAnswerToAnUnknownPath) {
  constexpr const char *kMissing = "422 Unprocessable Entity", *kUnknown = "404 Not Found";
  const struct {
    const char *known, *unknown, *state;
  } kServers[] = {{kMissing, kUnknown, "good"}, {kMissing, "501 Not Implemented", "good"},
                  {"200 OK", kUnknown, "good"}, {kMissing, kMissing, "bad"},
                  {"200 OK", "200 OK", "bad"},  {"204 No Content", "204 No Content", "bad"}};
  for (const auto& [known, unknown, state] : kServers) {
    loop::SimulatedTime time;
    loop::Loop loop;
    std::vector<std::string> requests;
    uplink::ListeningPeer peer([&](uplink::Wire& wire) {
      requests.push_back(wire.read_request());
      wire.write(uplink::answer(requests.size() == 1 ? known : unknown, ""));
    });
    TestTarget tried{.post = {}, .scoring = {}, .mapping = icd::BearerToken::parse("typed")};
    tried.post.interface = "";
    tried.post.mapping = {peer.endpoint().address, peer.endpoint().port};
    const EndpointTest::Turns turns;
    std::optional<api::TestStep> step;
    EndpointTest test(loop, turns, tried, steps::EndpointKind::Mapping,
                      [&](api::TestStep each) { step = std::move(each); });
    test.check_token();
    ASSERT_TRUE(time.pass_until(loop, [&] { return step.has_value(); }));
    EXPECT_EQ(step->state, state) << known << ", " << unknown << ": " << step->said;
    ASSERT_EQ(requests.size(), 2);
    EXPECT_TRUE(requests[0].starts_with("POST /state/update ")) << requests[0];
    EXPECT_TRUE(requests[1].starts_with("POST /adit-test ")) << requests[1];
  }
}

}  // namespace
}  // namespace adit::box
