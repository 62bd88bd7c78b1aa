#include "network/numbers.hpp"

#include <gmock/gmock.h>

#include "network/doubles.hpp"

namespace adit::network {
namespace {

using testing::ElementsAre;
using testing::StartsWith;

std::vector<std::string> faults(const std::string& json) {
  const auto value = codec::parse_json(json);
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
  EXPECT_EQ(json_of(numbers()), R"({"team":{"address":"192.168.7.11","prefix":24},)"
                                R"("command_post":{"address":"10.100.1.10","prefix":24,"gateway":""}})");
}

TEST(Numbers, NeedNoGateway) {
  for (const char* post :
       {R"({"address":"10.100.1.10","prefix":24})", R"({"address":"10.100.1.10","prefix":24,"gateway":""})",
        R"({"address":"10.100.1.10","prefix":24,"gateway":null})"}) {
    EXPECT_THAT(faults(with(kTeam, post)), ElementsAre()) << post;
  }
}

TEST(Numbers, AreRefusedByTheirPaths) {
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
       "team.address: 127.0.0.1 is no address that a host can have"},
      {R"({"address":"0.0.0.1","prefix":8})", kPost, "team.address: 0.0.0.1 is no"},
      {R"({"address":"224.0.0.9","prefix":24})", kPost, "team.address: 224.0.0.9 is no"},
      {R"({"address":"255.255.255.255","prefix":24})", kPost, "team.address: 255.255.255.255 is no"},
      {R"({"address":"192.168.7.11","prefix":24,"gateway":"192.168.7.1"})", kPost,
       "team.\"gateway\": no such member here"},
      {R"({"address":"192.168.7.11","prefix":24,"prefix":25})", kPost, "team.prefix: given twice"},
      {"[]", kPost, "team: expected an object, got an array"},
      {"null", kPost, "team: expected an object, got null"},
      {kTeam, R"({"address":"10.100.1.10","prefix":24,"gateway":"10.100.2.1"})",
       "command_post.gateway: 10.100.2.1 is not in 10.100.1.0/24, the subnet of its interface"},
      {kTeam, R"({"address":"10.100.1.10","prefix":24,"gateway":"10.100.1.10"})",
       "command_post.gateway: 10.100.1.10 is the box's own address"},
      {kTeam, R"({"address":"10.100.1.10","prefix":24,"gateway":"10.100.1.255"})",
       "command_post.gateway: 10.100.1.255 is the broadcast address"},
      {kTeam, R"({"address":"10.100.1.10","prefix":24,"gateway":7})",
       "command_post.gateway: expected an IPv4 address"},
      {kTeam, R"({"address":"10.100.1.10","prefix":24,"gateway":"none"})",
       "command_post.gateway: expected an IPv4"},
      {kTeam, R"({"address":"10.100.1.10","prefix":24,"interface":"eth0"})",
       "command_post.\"interface\": no such member"},
  };
  for (const auto& [team, post, sentence] : cases) {
    EXPECT_THAT(faults(with(team, post)), ElementsAre(StartsWith(sentence))) << team << post;
  }
}

TEST(Numbers, AreRefusedAllAtOnce) {
  EXPECT_THAT(faults(R"({"team":{"address":"x","prefix":99},"command_post":3,"more":1})"),
              ElementsAre(StartsWith("team.address: "), StartsWith("team.prefix: "),
                          "command_post: expected an object, got 3", "\"more\": no such member here"));
  EXPECT_THAT(faults("{}"), ElementsAre("team: missing", "command_post: missing"));
  EXPECT_THAT(faults("7"), ElementsAre("expected an object, got 7"));
}

}  // namespace
}  // namespace adit::network
