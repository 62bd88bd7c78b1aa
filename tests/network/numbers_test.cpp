#include "network/numbers.hpp"

#include <gmock/gmock.h>

#include "network/doubles.hpp"

namespace adit::network {
namespace {

using testing::ElementsAre;
using testing::StartsWith;

std::vector<std::string> faults(const std::string& text) {
  const auto value = codec::parse_json(text);
  if (!value) return {"no JSON"};
  const auto read = read_numbers(*value);
  std::vector<std::string> sentences;
  if (!read) {
    for (const auto& error : read.error()) sentences.push_back(error.sentence());
  }
  return sentences;
}

std::string with(const std::string& team, const std::string& post) {
  return R"({"team":)" + team + R"(,"command_post":)" + post + "}";
}

constexpr const char* kTeam = R"({"address":"192.168.7.11","prefix":24})";
constexpr const char* kPost = R"({"address":"10.100.1.10","prefix":24,"gateway":"10.100.1.1"})";

TEST(Numbers, AreReadAndWritten) {
  const Numbers all = numbers("192.168.7.11/24", "10.100.1.10/16", "10.100.0.1");
  const auto read = read_numbers(*codec::parse_json(json_of(all)));
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, all);
  EXPECT_EQ(json_of(numbers()),
            R"({"team":{"mode":"static","address":"192.168.7.11","prefix":24},)"
            R"("command_post":{"addresses":[{"address":"10.100.1.10","prefix":24}],"gateway":""}})");
  EXPECT_EQ(json_of(with_mode(Mode::Dhcp)),
            R"({"team":{"mode":"dhcp"},"command_post":{"addresses":[{"address":"10.100.1.10","prefix":24}],)"
            R"("gateway":""}})");
}

TEST(Numbers, MayHaveSeveralCommandPostAddressesOrNone) {
  Numbers all = numbers("192.168.7.11/24", "10.100.1.10/24", "10.100.2.1");
  all.command_post.push_back(host("10.100.2.10/24"));
  EXPECT_EQ(read_numbers(*codec::parse_json(json_of(all))), all) << "the gateway is in the second's subnet";
  EXPECT_EQ(command_post_text(all), "10.100.1.10/24, 10.100.2.10/24");
  all.command_post.clear();
  all.gateway.reset();
  EXPECT_EQ(read_numbers(*codec::parse_json(json_of(all))), all);
  EXPECT_EQ(command_post_text(all), "none");
  for (std::uint32_t i = 0; i < kMostAddresses; ++i) all.command_post.push_back({0x0a640101 + i, 24});
  EXPECT_EQ(read_numbers(*codec::parse_json(json_of(all))), all);
  all.command_post.push_back({0x0a6401fe, 24});
  EXPECT_THAT(faults(json_of(all)), ElementsAre("command_post.addresses: expected at most 8, got 9"));
}

TEST(Numbers, OfOtherModesHaveNoTeamAddress) {
  for (const Mode mode : {Mode::Dhcp, Mode::LinkLocal}) {
    EXPECT_EQ(read_numbers(*codec::parse_json(json_of(with_mode(mode)))), with_mode(mode));
    EXPECT_EQ(team_text(with_mode(mode)), name_of(mode));
  }
  EXPECT_THAT(faults(with(R"({"mode":"dhcp","address":"","prefix":null})", kPost)), ElementsAre());
  EXPECT_THAT(faults(with(R"({"mode":"dhcp","address":"192.168.7.11","prefix":24})", kPost)),
              ElementsAre("team.address: expected none with mode dhcp, got \"192.168.7.11\"",
                          "team.prefix: expected none with mode dhcp, got 24"));
}

TEST(Numbers, NeedNoGateway) {
  for (const char* post :
       {R"({"address":"10.100.1.10","prefix":24})", R"({"address":"10.100.1.10","prefix":24,"gateway":""})",
        R"({"address":"10.100.1.10","prefix":24,"gateway":null})"}) {
    EXPECT_THAT(faults(with(kTeam, post)), ElementsAre()) << post;
  }
}

TEST(Numbers, AreRejectedByTheirPaths) {
  const struct {
    const char *team, *post, *sentence;
  } cases[] = {
      {R"({"prefix":24})", kPost, "team.address: missing"},
      {R"({"address":"192.168.7.11"})", kPost, "team.prefix: missing"},
      {R"({"address":192,"prefix":24})", kPost,
       "team.address: expected an IPv4 address such as 192.168.7.11, got 192"},
      {R"({"address":"","prefix":24})", kPost, "team.address: expected an IPv4 address"},
      {R"({"address":"box","prefix":24})", kPost, "team.address: expected an IPv4 address"},
      {R"({"address":"192.168.7.11/24","prefix":24})", kPost, "team.address: expected an IPv4 address"},
      {R"({"address":"fd00::1","prefix":24})", kPost, "team.address: expected an IPv4 address"},
      {R"({"address":"192.168.7.11\n[Match]","prefix":24})", kPost, "team.address: expected an IPv4 address"},
      {R"({"address":"192.168.7.11","prefix":"24"})", kPost,
       "team.prefix: expected a whole number from 8 to 30"},
      {R"({"address":"192.168.7.11","prefix":7})", kPost,
       "team.prefix: expected a whole number from 8 to 30, got 7"},
      {R"({"address":"192.168.7.11","prefix":31})", kPost, "team.prefix: expected"},
      {R"({"address":"192.168.7.11","prefix":-24})", kPost, "team.prefix: expected"},
      {R"({"address":"192.168.7.11","prefix":24.5})", kPost, "team.prefix: expected"},
      {R"({"address":"192.168.7.11","prefix":18446744073709551615})", kPost, "team.prefix: expected"},
      {R"({"address":"192.168.7.0","prefix":24})", kPost,
       "team.address: 192.168.7.0 is the address of the subnet 192.168.7.0/24 itself"},
      {R"({"address":"192.168.7.255","prefix":24})", kPost,
       "team.address: 192.168.7.255 is the broadcast address of 192.168.7.0/24"},
      {R"({"address":"127.0.0.1","prefix":8})", kPost,
       "team.address: 127.0.0.1 is not an address that a host can have"},
      {R"({"address":"0.0.0.1","prefix":8})", kPost, "team.address: 0.0.0.1 is no"},
      {R"({"address":"224.0.0.9","prefix":24})", kPost, "team.address: 224.0.0.9 is no"},
      {R"({"address":"255.255.255.255","prefix":24})", kPost, "team.address: 255.255.255.255 is no"},
      {R"({"address":"192.168.7.11","prefix":24,"gateway":"192.168.7.1"})", kPost,
       "team.\"gateway\": unknown member"},
      {R"({"address":"192.168.7.11","prefix":24,"prefix":25})", kPost, "team.prefix: given twice"},
      {R"({"mode":"bootp","address":"192.168.7.11","prefix":24})", kPost,
       "team.mode: expected static, dhcp or link-local, got \"bootp\""},
      {R"({"mode":7,"address":"192.168.7.11","prefix":24})", kPost, "team.mode: expected static"},
      {R"({"mode":"static","prefix":24})", kPost, "team.address: missing"},
      {R"({"address":"169.254.7.11","prefix":16})", kPost, "team.address: 169.254.7.11 is link-local"},
      {R"({"address":"10.100.1.10","prefix":24})", kPost,
       "team.address: 10.100.1.10 is the box's address on the Command Post's side"},
      {"[]", kPost, "team: expected an object, got an array"},
      {"null", kPost, "team: expected an object, got null"},
      {kTeam, R"({"address":"10.100.1.10","prefix":24,"gateway":"10.100.2.1"})",
       "command_post.gateway: 10.100.2.1 is in no subnet of its interface, which has 10.100.1.10/24"},
      {kTeam, R"({"address":"10.100.1.10","prefix":24,"gateway":"10.100.1.10"})",
       "command_post.gateway: 10.100.1.10 is the box's own address"},
      {kTeam, R"({"address":"10.100.1.10","prefix":24,"gateway":"10.100.1.255"})",
       "command_post.gateway: 10.100.1.255 is the broadcast address"},
      {kTeam, R"({"address":"10.100.1.10","prefix":24,"gateway":7})",
       "command_post.gateway: expected an IPv4 address"},
      {kTeam, R"({"address":"10.100.1.10","prefix":24,"gateway":"none"})",
       "command_post.gateway: expected an IPv4"},
      {kTeam, R"({"gateway":""})", "command_post.addresses: missing"},
      {kTeam, R"({"addresses":"10.100.1.10/24","gateway":""})", "command_post.addresses: expected a list"},
      {kTeam, R"({"addresses":[],"gateway":"10.100.1.1"})",
       "command_post.gateway: 10.100.1.1 is in no subnet of its interface, which has none"},
      {kTeam, R"({"addresses":[{"address":"10.100.1.10"}]})", "command_post.addresses[0].prefix: missing"},
      {kTeam, R"({"addresses":["10.100.1.10/24"]})", "command_post.addresses[0]: expected an object"},
      {kTeam,
       R"({"addresses":[{"address":"10.100.1.10","prefix":24},{"address":"10.100.1.10","prefix":16}]})",
       "command_post.addresses[1].address: 10.100.1.10 is given twice"},
      {kTeam, R"({"addresses":[{"address":"169.254.1.1","prefix":16}]})",
       "command_post.addresses[0].address: 169.254.1.1 is link-local"},
      {kTeam, R"({"addresses":[{"address":"10.100.1.10","prefix":24,"name":"x"}]})",
       "command_post.addresses[0].\"name\": unknown member"},
      {kTeam, R"({"addresses":[],"address":"10.100.1.10"})", "command_post.\"address\": unknown member"},
      {kTeam, R"({"address":"10.100.1.10","prefix":24,"interface":"eth0"})",
       "command_post.\"interface\": unknown member"},
  };
  for (const auto& [team, post, sentence] : cases) {
    EXPECT_THAT(faults(with(team, post)), ElementsAre(StartsWith(sentence))) << team << post;
  }
}

TEST(Numbers, AreRejectedAllAtOnce) {
  EXPECT_THAT(faults(R"({"team":{"address":"x","prefix":99},"command_post":3,"more":1})"),
              ElementsAre(StartsWith("team.address: "), StartsWith("team.prefix: "),
                          "command_post: expected an object, got 3", "\"more\": unknown member"));
  EXPECT_THAT(faults("{}"), ElementsAre("team: missing", "command_post: missing"));
  EXPECT_THAT(faults("7"), ElementsAre("expected an object, got 7"));
}

}  // namespace
}  // namespace adit::network
