#include "applier/options.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace adit::applier {
namespace {

using testing::HasSubstr;

std::expected<Options, std::string> parse(const std::vector<const char*>& words) {
  return parse_options(words);
}

TEST(AditNetworkOptions, DefaultToTheServicesDirectories) {
  const auto options = parse({});
  ASSERT_TRUE(options);
  EXPECT_EQ(options->wanted, "/var/lib/private/adit");
  EXPECT_EQ(options->team, "team0");
  EXPECT_EQ(options->command_post, "darpa0");
  EXPECT_EQ(parse({"--networkd", "/tmp/x", "--team", "eth0.7"})->networkd, "/tmp/x");
}

TEST(AditNetworkOptions, SelectOnlyTheFilesOfTheStart) {
  EXPECT_FALSE(parse({})->start);
  EXPECT_TRUE(parse({"--start", "--team", "eth0"})->start);
}

TEST(AditNetworkOptions, SelectOnlyTheWatch) {
  EXPECT_TRUE(parse({"--watch", "--status", "/tmp/x"})->watch);
  EXPECT_EQ(parse({"--watch"})->told, "/run/adit-network");
  EXPECT_THAT(parse({"--watch", "--start"}).error(), HasSubstr("exclude each other"));
  EXPECT_THAT(parse({"--watch", "--ports"}).error(), HasSubstr("exclude each other"));
}

TEST(AditNetworkOptions, AreRejectedByName) {
  EXPECT_THAT(parse({"--wnated", "x"}).error(), HasSubstr("--wnated"));
  EXPECT_THAT(parse({"--wanted"}).error(), HasSubstr("--wanted wants a value"));
  EXPECT_THAT(parse({"--factory", ""}).error(), HasSubstr("--factory wants a value"));
  for (const char* name :
       {"*", "eth*", "!team0", "a b", "eth0\nName=*", "..", ".", "sixteen-letters-", "a/b", "en:0"}) {
    EXPECT_THAT(parse({"--team", name}).error(), HasSubstr("--team: expected an interface's name")) << name;
    EXPECT_THAT(parse({"--command-post", name}).error(), HasSubstr("--command-post: expected an interface"))
        << name;
  }
  EXPECT_THAT(parse({"--team", "darpa0"}).error(), HasSubstr("the same interface"));
}

}  // namespace
}  // namespace adit::applier
