#include <gmock/gmock.h>

#include <cerrno>

#include "box/self_test.hpp"

namespace adit::box::steps {
namespace {

using testing::HasSubstr;

const settings::Subnet kOwn{0x0a64010a, 24};

void expect(const TestStep& step, const std::string& state, const std::string& said) {
  EXPECT_EQ(step.state, state) << step.said;
  EXPECT_THAT(step.said, HasSubstr(said));
  EXPECT_EQ(step.advice.empty(), state != "bad") << "each bad step needs advice: " << step.advice;
}

TEST(LinkStep, ChecksTheCarrier) {
  expect(link("darpa0", true), "good", "darpa0 has a carrier");
  expect(link("darpa0", false), "bad", "darpa0 has no carrier");
  expect(link("darpa0", std::nullopt), "bad", "there is no interface darpa0");
  expect(link("", true), "skipped", "command_post.interface");
}

TEST(AddressStep, FindsAddressConflicts) {
  network::ProbeResult probed{.nonce = "", .address = "10.100.1.10"};
  expect(address("darpa0", kOwn, probed, ""), "good",
         "darpa0 has 10.100.1.10/24, without an address conflict");
  probed.address = "10.100.1.11";
  probed.claimant = "02:00:00:00:00:09";
  expect(address("darpa0", kOwn, probed, ""), "bad", "darpa0 has 10.100.1.11, but the machine");
  probed.address = "10.100.1.10";
  expect(address("darpa0", kOwn, probed, ""), "bad", "but the machine 02:00:00:00:00:09");
  probed.own = "team0";
  expect(address("darpa0", kOwn, probed, ""), "bad", "the box's own team0 also answers for this address");
  probed.trouble = "darpa0: Network is down";
  expect(address("darpa0", kOwn, probed, ""), "skipped", "Network is down");
  expect(address("darpa0", kOwn, std::nullopt, "adit-network does not run here"), "skipped",
         "adit-network does not run");
  expect(address("darpa0", std::nullopt, std::nullopt, ""), "bad", "darpa0 has no IPv4 address");
  expect(address("darpa0", std::unexpected("cannot read it"), std::nullopt, ""), "skipped", "cannot read it");
  expect(address("", kOwn, std::nullopt, ""), "skipped", "command_post.interface");
}

TEST(CablesStep, SeeksTheCommandPostAtBothPorts) {
  network::ProbeResult probed{.nonce = "", .found_on = "darpa0"};
  expect(cables("darpa0", "team0", "10.100.1.200", probed), "good", "10.100.1.200 is at darpa0");
  probed.found_on = "team0";
  expect(cables("darpa0", "team0", "10.100.1.200", probed), "bad",
         "10.100.1.200 is not at darpa0 but at team0");
  probed.found_on = "";
  expect(cables("darpa0", "team0", "10.100.1.200", probed), "skipped", "no machine answers for 10.100.1.200");
  probed.not_sought = "team0: Network is down";
  expect(cables("darpa0", "team0", "10.100.1.200", probed), "skipped", "team0: Network is down");
  expect(cables("darpa0", "team0", "", probed), "skipped", "could not check");
  expect(cables("darpa0", "team0", "10.100.1.200", std::nullopt), "skipped", "could not check");
}

TEST(ReachStep, TellsHowConnectingFails) {
  const std::string at = "10.100.1.200:8000";
  expect(reach(at, 0, ""), "good", "10.100.1.200:8000 accepts a connection");
  expect(reach(at, 0, "\"x\" is no IP address"), "bad", "is no IP address");
  expect(reach(at, ECONNREFUSED, "Connection refused"), "bad", "no server at that port");
  expect(reach(at, ENETUNREACH, "Network is unreachable"), "bad", "there is no route to");
  expect(reach(at, EHOSTUNREACH, "No route to host"), "bad", "no machine answers");
  expect(reach(at, ETIMEDOUT, "Connection timed out"), "bad", "does not answer");
  expect(reach(at, ENODEV, "binding to interface darpa0: No such device"), "bad", "darpa0");
  expect(reach(at, EACCES, "Permission denied"), "bad", "Permission denied");
  std::vector<std::string> advice;
  for (const int error : {ECONNREFUSED, ENETUNREACH, EHOSTUNREACH, ETIMEDOUT})
    advice.push_back(reach(at, error, "").advice);
  std::ranges::sort(advice);
  EXPECT_EQ(std::ranges::adjacent_find(advice), advice.end()) << "each step has its own advice";
}

TestStep with_status(EndpointKind asked, int status, const std::string& body = "\"a sentence\"") {
  uplink::Answered answered;
  answered.status = status;
  answered.body = body;
  return token(asked, answered);
}

constexpr const char* kRun =
    R"({"score": 1, "run_clock": 2.5, "remaining_reports": 44, "current_team": "subt"})";

TEST(TokenStep, OfScoringReadsTheAnswerToAStatus) {
  expect(with_status(EndpointKind::Scoring, 200, kRun), "good", "the scoring token is accepted");
  for (const char* body : {R"({"hello": "world"})", "null", "[]", R"("a sentence")", ""})
    expect(with_status(EndpointKind::Scoring, 200, body), "bad", "not the status of a run");
  expect(with_status(EndpointKind::Scoring, 401), "bad", "the scoring token is rejected");
  expect(with_status(EndpointKind::Scoring, 403), "bad", "the scoring token is rejected");
  expect(with_status(EndpointKind::Scoring, 404, "<html>"), "bad", "404");
  expect(with_status(EndpointKind::Scoring, 422), "bad", "422");
  expect(with_status(EndpointKind::Scoring, 501, ""), "bad", "501");
  expect(with_status(EndpointKind::Scoring, 429), "skipped", "too many requests");
  expect(with_status(EndpointKind::Scoring, 500), "skipped", "failed");
  expect(no_token(EndpointKind::Scoring), "bad", "there is no scoring token");
}

TEST(TokenStep, OfMappingIsGoodIfOnlyTheBodyIsRejected) {
  for (const int status : {200, 201, 400, 415, 422})
    expect(with_status(EndpointKind::Mapping, status), "good", "is accepted");
  for (const int status : {401, 403})
    expect(with_status(EndpointKind::Mapping, status), "bad", "the mapping token is rejected");
  for (const int status : {404, 405, 501})
    expect(with_status(EndpointKind::Mapping, status, ""), "bad", std::to_string(status));
  EXPECT_THAT(with_status(EndpointKind::Mapping, 404).advice, HasSubstr("no mapping endpoint"));
  expect(with_status(EndpointKind::Mapping, 429), "skipped", "too many requests");
}

TestStep with_statuses(int status, int elsewhere) {
  uplink::Answered answered;
  answered.status = elsewhere;
  return unknown_path(with_status(EndpointKind::Mapping, status), status, answered);
}

TEST(TokenStep, OfMappingIsBadIfTheServerAcceptsAnyPath) {
  for (const int status : {200, 400, 415, 422}) {
    for (const int elsewhere : {401, 404, 405, 500, 501})
      expect(with_statuses(status, elsewhere), "good", "is accepted");
    expect(with_statuses(status, status), "bad", "accepts any path");
    expect(with_statuses(status, 429), "skipped", "POST /adit-test got no answer");
  }
  expect(with_statuses(200, 204), "bad", "accepts any path");
  EXPECT_THAT(with_statuses(422, 422).advice, HasSubstr("compare the mapping address and port"));
  expect(unknown_path(with_status(EndpointKind::Mapping, 422), 422, uplink::InDoubt{"the peer was silent"}),
         "skipped", "POST /adit-test got no answer");
}

TEST(TokenStep, TellsAPageFromAnAnswerWithoutABody) {
  expect(with_status(EndpointKind::Mapping, 200, "<html>"), "bad",
         "the answer is 200 with a body that is not JSON");
  expect(with_status(EndpointKind::Mapping, 501, ""), "bad", "the answer is 501 without a body");
  expect(with_status(EndpointKind::Mapping, 404, R"({"detail": "Not Found"})"), "bad",
         "the answer is 404: Not Found");
}

TEST(TokenStep, TellsThatTheEndpointRequiresASlash) {
  const uplink::Answered taken{.status = 200, .content_type = "", .body = kRun, .retry_after = std::nullopt};
  EXPECT_THAT(token(EndpointKind::Scoring, taken, true).said, HasSubstr("slash"));
  EXPECT_THAT(token(EndpointKind::Scoring, taken).said, testing::Not(HasSubstr("slash")));
}

TEST(TokenStep, TellsWhyNoAnswerCame) {
  expect(token(EndpointKind::Scoring, uplink::NeverSent{"connecting: Connection refused"}), "bad",
         "Connection refused");
  expect(token(EndpointKind::Mapping, uplink::InDoubt{"the peer was silent"}), "bad", "the peer was silent");
}

TEST(ClockStep, AllowsTwoSeconds) {
  const auto at = [](double now) { return clock(std::chrono::sys_seconds(std::chrono::seconds(1000)), now); };
  for (const double now : {998.0, 999.5, 1000.0, 1000.99, 1001.0, 1003.0}) expect(at(now), "good", "agrees");
  expect(at(997.4), "bad", "3 s behind");
  expect(at(1003.6), "bad", "3 s ahead of");
  expect(at(1e9), "bad", "ahead of");
  expect(clock(std::nullopt, 1000), "skipped", "have no Date");
}

TEST(ClockStep, FallsBackToTheRunClock) {
  expect(run_clock(10.0, 11.5), "good", "the run clock moves");
  expect(run_clock(0.0, 0.0), "skipped", "the run clock stands at 0 s");
  expect(run_clock(10.0, std::nullopt), "skipped", "no run clock");
}

}  // namespace
}  // namespace adit::box::steps
