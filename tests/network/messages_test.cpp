#include "network/messages.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "network/doubles.hpp"

namespace adit::network {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kNonce = "0123456789abcdef0123456789abcdef";

TEST(NetworkMessages, ReadBackTheSame) {
  const auto wanted = codec::read_file<ChangeRequest>(
      codec::write_file(ChangeRequest{kNonce, std::chrono::milliseconds(90000), numbers()}));
  ASSERT_TRUE(wanted) << wanted.error();
  EXPECT_EQ(wanted->nonce, kNonce);
  EXPECT_EQ(wanted->confirm_within.count(), 90000);
  EXPECT_EQ(wanted->numbers, numbers());
  for (const auto what : {Decision::Command::Confirm, Decision::Command::Revert}) {
    const auto word = codec::read_file<Decision>(codec::write_file(Decision{kNonce, what}));
    ASSERT_TRUE(word);
    EXPECT_EQ(word->what, what);
  }
  ASSERT_TRUE(codec::read_file<Probe>(codec::write_file(Probe{kNonce})));
  EXPECT_EQ(codec::read_file<Probe>(codec::write_file(Probe{kNonce, "10.100.1.200"}))->sought,
            "10.100.1.200");
  EXPECT_EQ(codec::read_file<FactoryRequest>(codec::write_file(FactoryRequest{kNonce}))->nonce, kNonce);
  for (const Endpoints& each : {Endpoints{}, Endpoints{{0x0a6401c8, 0x0a6401c9}}}) {
    EXPECT_EQ(codec::read_file<Endpoints>(codec::write_file(each)), each);
  }
  const auto probed = codec::read_file<ProbeResult>(
      codec::write_file(ProbeResult{kNonce, "10.100.1.10", "02:00:00:00:00:01", "team0", "darpa0", "none"}));
  ASSERT_TRUE(probed);
  EXPECT_EQ(probed->claimant, "02:00:00:00:00:01");
  EXPECT_EQ(probed->found_on, "darpa0");
  for (const Numbers& each : {numbers(), with_mode(Mode::Dhcp), with_mode(Mode::LinkLocal)}) {
    EXPECT_EQ(read_kept(write_kept(each)), each);
  }
}

TEST(NetworkMessages, HaveTheWholeStatus) {
  Status status{.team_interface = "team0", .command_post_interface = "darpa0"};
  EXPECT_EQ(codec::read_file<Status>(codec::write_file(status)), status);
  status.kept = numbers();
  status.endpoints = {{0x0a6401c8}};
  status.pending = Pending{kNonce, numbers("10.0.0.1/8"), Instant(std::chrono::milliseconds(123456)),
                           std::chrono::seconds(5)};
  status.ended = ChangeOutcome::Reverted;
  status.ended_nonce = kNonce;
  status.why = "the change was not confirmed";
  status.trouble = "networkctl reload: exit status 1";
  EXPECT_EQ(codec::read_file<Status>(codec::write_file(status)), status);
  EXPECT_EQ(json::parse(codec::write_file(status))["pending"]["until_ms"], 123456);
}

TEST(NetworkMessages, HaveAddressConflicts) {
  AddressConflicts taken;
  EXPECT_EQ(codec::read_file<AddressConflicts>(codec::write_file(taken)), taken);
  taken.addresses.push_back(
      {"team0", "10.0.0.1", "02:00:5e:10:00:01", Instant(std::chrono::milliseconds(5))});
  EXPECT_EQ(codec::read_file<AddressConflicts>(codec::write_file(taken)), taken);
  taken.exchanged.push_back(
      {"team0", "10.100.1.200", "02:00:5e:10:00:02", Instant(std::chrono::milliseconds(6))});
  EXPECT_EQ(codec::read_file<AddressConflicts>(codec::write_file(taken)), taken);
  const std::tuple<const char*, json, const char*> cases[] = {
      {"address", "10.0.0.1; rm", "taken[0].address: expected an IPv4 address"},
      {"address", "", "taken[0].address"},
      {"mac", "", "taken[0].mac: expected a MAC address"},
      {"mac", "02:00:5e:10:00:0", "taken[0].mac"},
      {"mac", "02:00:5e:10:00:0g", "taken[0].mac"},
      {"mac", "02-00-5e-10-00-01", "taken[0].mac"},
      {"mac", "<b>02:00:5e:10:00", "taken[0].mac"},
      {"seen_ms", -1, "taken[0].seen_ms"},
      {"interface", 7, "taken[0].interface"},
      {"else", 7, "else"},
  };
  for (const auto& [name, value, why] : cases) {
    json bad = json::parse(codec::write_file(taken));
    bad["taken"][0][name] = value;
    const auto result = codec::read_file<AddressConflicts>(bad.dump());
    ASSERT_FALSE(result) << bad;
    EXPECT_THAT(result.error(), HasSubstr(why));
  }
  taken.addresses.resize(kMostTaken + 1, taken.addresses.front());
  EXPECT_THAT(codec::read_file<AddressConflicts>(codec::write_file(taken)).error(),
              HasSubstr("taken: expected at most 32"));
}

TEST(NetworkMessages, RejectTimesBeyondTheClock) {
  const Status status{.team_interface = "team0",
                      .command_post_interface = "darpa0",
                      .pending = Pending{kNonce, numbers(), Instant(), std::chrono::seconds(5)}};
  for (const char* until :
       {"-1", "-9223372036854775808", "9223372036854", "9223372036855", "9223372036854775807", "\"soon\""}) {
    json bad = json::parse(codec::write_file(status));
    bad["pending"]["until_ms"] = json::parse(until);
    const auto result = codec::read_file<Status>(bad.dump());
    const bool fits = std::string_view(until) == "9223372036854";  // as nanoseconds, in 63 bits
    ASSERT_EQ(result.has_value(), fits) << until;
    if (fits) continue;
    EXPECT_THAT(result.error(), HasSubstr("pending.until_ms")) << until;
  }
}

/// Messages that a compromised gateway could write.
TEST(NetworkMessages, AreRejectedIfHostile) {
  const json good =
      json::parse(codec::write_file(ChangeRequest{kNonce, std::chrono::milliseconds(90000), numbers()}));
  const std::pair<const char*, const char*> cases[] = {
      {R"({"nonce":"0123"})", "nonce: expected 32 hexadecimal digits"},
      {R"({"confirm_within_ms":999})", "confirm_within_ms"},
      {R"({"confirm_within_ms":600001})", "confirm_within_ms"},
      {R"({"confirm_within_ms":-1})", "confirm_within_ms"},
      {R"({"confirm_within_ms":"90000"})", "confirm_within_ms"},
      {R"({"numbers":null})", "numbers"},
      {R"({"numbers":"x"})", "numbers: expected an object"},
      {R"({"numbers":{"team":{"address":"1.2.3.4\n[Network]\nDHCP=yes"}}})",
       "numbers: team.address: expected an IPv4"},
  };
  for (const auto& [change, what] : cases) {
    json bad = good;
    bad.update(json::parse(change));
    const auto result = codec::read_file<ChangeRequest>(bad.dump());
    ASSERT_FALSE(result) << change;
    EXPECT_THAT(result.error(), HasSubstr(what));
  }
  for (const char* text : {"", "{", "[]", "null", "7", "{\"format\":1}", "\xff\xfe"}) {
    EXPECT_FALSE(codec::read_file<ChangeRequest>(text)) << text;
    EXPECT_FALSE(codec::read_file<Decision>(text)) << text;
    EXPECT_FALSE(codec::read_file<Probe>(text)) << text;
    EXPECT_FALSE(codec::read_file<Endpoints>(text)) << text;
    EXPECT_FALSE(codec::read_file<FactoryRequest>(text)) << text;
    EXPECT_FALSE(codec::read_file<Status>(text)) << text;
    EXPECT_FALSE(codec::read_file<ProbeResult>(text)) << text;
    EXPECT_FALSE(read_kept(text)) << text;
  }
  EXPECT_FALSE(codec::read_file<Decision>(R"({"format":1,"nonce":")" + kNonce + R"(","word":"maybe"})"));
  EXPECT_FALSE(codec::read_file<Decision>(R"({"format":1,"nonce":"x","word":"revert"})"));
  EXPECT_FALSE(codec::read_file<FactoryRequest>(R"({"format":1,"nonce":"x"})"));
  EXPECT_FALSE(codec::read_file<Probe>(R"({"format":1,"nonce":")" + kNonce + R"(","sought":"adit.local"})"));
}

TEST(NetworkMessages, RejectInvalidEndpoints) {
  const std::pair<const char*, const char*> cases[] = {
      {R"("10.100.1.200")", "endpoints"},
      {R"(["10.100.1"])", "endpoints[0]: expected an IPv4 address"},
      {R"(["10.100.1.200\nGateway=1.2.3.4"])", "endpoints[0]"},
      {R"([7])", "endpoints[0]"},
      {R"(["10.100.1.201","10.100.1.200"])", "endpoints[1]: expected ascending addresses"},
      {R"(["10.100.1.201","10.100.1.201"])", "each once"},
  };
  for (const auto& [list, what] : cases) {
    const auto result = codec::read_file<Endpoints>(std::string(R"({"format":1,"endpoints":)") + list + "}");
    ASSERT_FALSE(result) << list;
    EXPECT_THAT(result.error(), HasSubstr(what));
  }
  Endpoints many;
  for (std::uint32_t i = 0; i < kMostEndpoints; ++i) many.addresses.push_back(i + 1);
  EXPECT_TRUE(codec::read_file<Endpoints>(codec::write_file(many)));
  many.addresses.push_back(99);
  EXPECT_THAT(codec::read_file<Endpoints>(codec::write_file(many)).error(), HasSubstr("at most 64"));
}

TEST(NetworkMessages, PortsBecomeRulesOfTheFirewall) {
  const TeamPorts ports{{80, 8000, 9000}};
  EXPECT_EQ(codec::read_file<TeamPorts>(codec::write_file(ports)), ports);
  EXPECT_EQ(rules_for({{9000, 80, 9000}}),
            "flush set inet adit team_ports\n"
            "add element inet adit team_ports { 80 }\n"
            "add element inet adit team_ports { 9000 }\n");
  EXPECT_EQ(rules_for({}), "flush set inet adit team_ports\n");
  for (const char* const list :
       {R"("80")", R"(["80"])", "[65536]", "[-1]", "[80.5]", R"(["80 }; flush ruleset"])", "{}"})
    EXPECT_FALSE(codec::read_file<TeamPorts>(std::string(R"({"format":1,"ports":)") + list + "}")) << list;
  TeamPorts many;
  many.ports.resize(kMostTeamPorts);
  EXPECT_TRUE(codec::read_file<TeamPorts>(codec::write_file(many)));
  many.ports.push_back(1);
  EXPECT_FALSE(codec::read_file<TeamPorts>(codec::write_file(many)));
}

/// Files of an earlier version of adit-network.
TEST(NetworkMessages, ReadFilesOfAnEarlierVersion) {
  EXPECT_EQ(read_kept(R"({"format":1,"numbers":{"team":{"address":"192.168.7.11","prefix":24},)"
                      R"("command_post":{"address":"10.100.1.10","prefix":24,"gateway":""}}})"),
            numbers());
}

}  // namespace
}  // namespace adit::network
