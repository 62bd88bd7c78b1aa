#include "gateway/options.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace adit::gateway {
namespace {

std::expected<Options, std::string> parse(const std::vector<const char*>& words) {
  return command_line::read(command_line_of, words);
}

TEST(Options, AreTheThreeRequiredOnes) {
  const auto options = parse({"--settings", "a.json", "--secrets", "b", "--state", "c"});
  ASSERT_TRUE(options);
  EXPECT_EQ(options->settings, "a.json");
  EXPECT_EQ(options->secrets, "b");
  EXPECT_EQ(options->state, "c");
}

TEST(Options, MayNameTheBoardAndOtherDirectories) {
  const auto options = parse({"--settings", "a", "--secrets", "b", "--state", "c", "--board", "d",
                              "--network", "e", "--notices", "f", "--block", "g"});
  ASSERT_TRUE(options);
  EXPECT_EQ(options->board, "d");
  EXPECT_EQ(options->network, "e");
  EXPECT_EQ(options->notices, "f");
  EXPECT_EQ(options->block, "g");
  EXPECT_EQ(parse({"--settings", "a", "--secrets", "b", "--state", "c"})->board, "");
  EXPECT_EQ(parse({"--board"}).error(), "--board wants a value");
}

TEST(Options, NameMissingAndUnknownOnes) {
  EXPECT_EQ(parse({"--settings", "a"}).error(), "--secrets DIR is missing");
  EXPECT_EQ(parse({"--settings"}).error(), "--settings wants a value");
  EXPECT_EQ(parse({"--setings", "a"}).error(), "unknown word '--setings'; did you mean --settings?");
  EXPECT_EQ(parse({}).error(), "--settings FILE is missing");
}

TEST(Options, HelpAndVersionNeedNoOthers) {
  EXPECT_TRUE(parse({"--help"})->help);
  EXPECT_TRUE(parse({"--version"})->version);
}

}  // namespace
}  // namespace adit::gateway
