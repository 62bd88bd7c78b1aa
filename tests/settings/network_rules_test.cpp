#include "settings/network_rules.hpp"

#include <gmock/gmock.h>

#include "settings/sample.hpp"

namespace adit::settings {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> errors_of(const std::string& network, const std::string& at_top = "") {
  const auto settings = parse(sample("", "", R"(, "network": {)" + network + "}" + at_top));
  std::vector<std::string> sentences;
  if (settings) return sentences;
  for (const Error& error : settings.error()) sentences.push_back(error.sentence());
  return sentences;
}

std::string team(const std::string& address, int prefix) {
  return R"("team": {"address": ")" + address + R"(", "prefix": )" + std::to_string(prefix) + "}";
}
std::string command_post(const std::string& address, int prefix, const std::string& gateway = "") {
  return R"("command_post": {"address": ")" + address + R"(", "prefix": )" + std::to_string(prefix) +
         R"(, "gateway": ")" + gateway + R"("})";
}

constexpr const char* kChoose = ": choose another subnet for the team, or allow it by network.allow_overlap";

TEST(NetworkRules, TakeSubnetsThatAreApart) {
  EXPECT_THAT(errors_of(team("192.168.7.1", 24) + ", " + command_post("10.100.1.10", 16, "10.100.0.1")),
              ElementsAre());
  EXPECT_THAT(errors_of(team("10.1.0.1", 24)), ElementsAre()) << "beside 10.1.1.0/24";
  EXPECT_THAT(errors_of(team("10.101.0.1", 16)), ElementsAre()) << "beside 10.100.0.0/16";
  EXPECT_THAT(errors_of(R"("confirm_within_ms": 5000)"), ElementsAre()) << "addresses are set elsewhere";
}

TEST(NetworkRules, RefuseATeamSubnetThatOverlapsTheCommandPosts) {
  struct Row {
    std::string address;
    int prefix;
    std::string what;
  };
  const Row rows[] = {
      {"10.1.1.5", 24, "10.1.1.0/24 overlaps 10.1.1.0/24, which the Command Post uses (ICD 3)"},
      {"10.1.1.129", 25, "10.1.1.128/25 overlaps 10.1.1.0/24, which the Command Post uses (ICD 3)"},
      {"10.2.0.1", 16, "10.2.0.0/16 overlaps 10.2.1.0/24, which the Command Post uses (ICD 3)"},
      {"10.100.77.1", 24, "10.100.77.0/24 overlaps 10.100.0.0/16, which the Command Post uses (ICD 3)"},
      {"10.0.0.1", 8, "10.0.0.0/8 overlaps 10.1.1.0/24, which the Command Post uses (ICD 3)"}};
  for (const Row& row : rows) {
    EXPECT_THAT(errors_of(team(row.address, row.prefix)),
                ElementsAre("network.team.address: " + row.what + kChoose));
    EXPECT_THAT(errors_of(team(row.address, row.prefix) + R"(, "allow_overlap": true)"), ElementsAre())
        << "on purpose";
  }
}

TEST(NetworkRules, RefuseATeamSubnetThatHoldsWhatElseIsSetForTheCommandPost) {
  EXPECT_THAT(errors_of(team("172.16.0.1", 16) + ", " + command_post("172.16.5.2", 24)),
              ElementsAre("network.team.address: 172.16.0.0/16 overlaps 172.16.5.0/24, the subnet of "
                          "network.command_post.address" +
                          std::string(kChoose)));
  const std::string course =
      R"(, "courses": [{"name": "A", "scoring": {"address": "10.100.1.200", "port": 1},)"
      R"( "mapping": {"address": "192.168.7.9", "port": 1}}])";
  EXPECT_THAT(errors_of(team("192.168.7.1", 24), course),
              ElementsAre("network.team.address: 192.168.7.0/24 holds courses[0].mapping.address" +
                          std::string(kChoose)));
}

TEST(NetworkRules, RefuseAddressesThatNoHostCanHave) {
  EXPECT_THAT(errors_of(team("192.168.7.0", 24)),
              ElementsAre("network.team.address: 192.168.7.0 is the subnet 192.168.7.0/24 itself"));
  EXPECT_THAT(errors_of(team("192.168.7.255", 24)),
              ElementsAre("network.team.address: 192.168.7.255 is the broadcast address of 192.168.7.0/24"));
  for (const std::string address : {"127.0.0.1", "224.0.0.1", "255.255.255.255", "0.0.0.0"}) {
    EXPECT_THAT(errors_of(team(address, 24)), ElementsAre(HasSubstr("is no address that a host can have")));
  }
  EXPECT_THAT(errors_of(team("fd00::1", 24)), ElementsAre(HasSubstr("expected an IPv4 address, or \"\"")));
  EXPECT_THAT(errors_of(team("192.168.7.1", 31)),
              ElementsAre("network.team.prefix: expected a whole number from 8 to 30, got 31"));
}

TEST(NetworkRules, RefuseAGatewayThatCannotBeReached) {
  const std::string path = "network.command_post.gateway: ";
  EXPECT_THAT(
      errors_of(command_post("10.100.1.10", 24, "10.100.2.1")),
      ElementsAre(path + "10.100.2.1 is not in 10.100.1.0/24, the subnet of network.command_post.address"));
  EXPECT_THAT(errors_of(command_post("10.100.1.10", 24, "10.100.1.10")),
              ElementsAre(path + "the same as network.command_post.address"));
  EXPECT_THAT(errors_of(command_post("10.100.1.10", 24, "10.100.1.255")),
              ElementsAre(path + "10.100.1.255 is the broadcast address of 10.100.1.0/24"));
  EXPECT_THAT(errors_of(command_post("", 24, "10.100.1.1")),
              ElementsAre(path + "a gateway is set, but network.command_post.address is not"));
}

}  // namespace
}  // namespace adit::settings
