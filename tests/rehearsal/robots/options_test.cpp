#include "rehearsal/robots/options.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <initializer_list>

namespace adit::robots {
namespace {

std::expected<Options, std::string> parsed(std::vector<const char*> arguments) {
  return parse_options(arguments);
}

/// A directory with the given files, which are empty.
class Maps {
 public:
  explicit Maps(std::initializer_list<const char*> files) {
    std::filesystem::create_directories(path_);
    for (const char* const file : files) std::ofstream(path_ / file) << std::flush;
  }
  ~Maps() { std::filesystem::remove_all(path_); }
  Maps(const Maps&) = delete;
  Maps& operator=(const Maps&) = delete;

  const char* path() const { return path_.c_str(); }

 private:
  const std::filesystem::path path_ = testing::TempDir() + "adit_robots_options_" + std::to_string(getpid());
};

TEST(Options, AcceptTheContractsCommandLine) {
  const Maps maps{"cave.ply"};
  const auto options = parsed({"--post", "http://127.0.0.1:8080", "--secrets", "/tmp", "--robots", "5",
                               "--style", "ros", "--maps", maps.path(), "--for", "30"});
  ASSERT_TRUE(options) << options.error();
  EXPECT_EQ(options->post.host, "127.0.0.1");
  EXPECT_EQ(options->post.port, 8080);
  EXPECT_EQ(options->scoring.port, 8080) << "one address for all";
  EXPECT_EQ(options->robots, 5u);
  EXPECT_EQ(options->style.style_of(3).name, "ros");
  EXPECT_EQ(options->run_for->count(), 30);
  EXPECT_EQ(options->maps, std::vector{std::filesystem::path(maps.path()) / "cave.ply"});
}

TEST(Options, AreCheckedBesideHelp) {
  EXPECT_TRUE(parsed({"--style", "ros", "--help"}));
  const Maps maps{"readme.txt"};
  const std::pair<std::vector<const char*>, std::string> cases[] = {
      {{"--robots", "0", "--help"}, "--robots 0: needs --maps"},
      {{"--maps", "/nowhere", "--help"}, "--maps: /nowhere: No such file or directory"},
      {{"--help", "--maps", maps.path()}, std::string("--maps: no .pgm, .pcd or .ply under ") + maps.path()},
  };
  for (const auto& [arguments, sentence] : cases) {
    const auto options = parsed(arguments);
    ASSERT_FALSE(options) << sentence;
    EXPECT_EQ(options.error(), sentence);
  }
}

TEST(Options, DefaultToThreeRobotsOfMixedStyle) {
  const auto options = parsed({"--post", "http://[::1]:80/", "--secrets", "/tmp"});
  ASSERT_TRUE(options) << options.error();
  EXPECT_EQ(options->post.host, "::1");
  EXPECT_EQ(options->robots, 3u);
  EXPECT_EQ(options->style.style_of(1).name, "cbor-body-gzip");
  EXPECT_FALSE(options->run_for);
}

TEST(Options, NameTheWrongArgument) {
  const std::pair<std::vector<const char*>, const char*> cases[] = {
      {{}, "--post"},
      {{"--post", "http://127.0.0.1:80"}, "--secrets"},
      {{"--post"}, "--post wants a value"},
      {{"--post", "127.0.0.1:80"}, "does not start with http://"},
      {{"--post", "http://127.0.0.1"}, "no port"},
      {{"--post", "http://127.0.0.1:0"}, "1 to 65535"},
      {{"--post", "http://127.0.0.1:65536"}, "1 to 65535"},
      {{"--post", "http://cave:80"}, "not an IP address"},
      {{"--robots", "-1"}, "--robots: expected 0 to 50"},
      {{"--robots", "51"}, "--robots"},
      {{"--for", "nan"}, "--for: expected 0 to 1e+06"},
      {{"--speed", "0"}, "--speed"},
      {{"--style", "morse"}, "unknown style 'morse'"},
      {{"--grids", "whole,torn"},
       "--grids: expected whole, drifting, rolling, tiles, none, got 'whole,torn'"},
      {{"--clouds", "all"}, "--clouds: expected differential"},
      {{"--cloud-hz", "11"}, "--cloud-hz"},
      {{"--frobnicate", "1"}, "unknown word '--frobnicate'"},
      {{"--generate-only"}, "needs --truth"},
  };
  for (const auto& [arguments, sentence] : cases) {
    const auto options = parsed(arguments);
    ASSERT_FALSE(options) << sentence;
    EXPECT_NE(options.error().find(sentence), std::string::npos) << options.error();
  }
}

TEST(Options, GiveEachRobotTheNextFormOfMaps) {
  const auto options = parsed({"--post", "http://127.0.0.1:80", "--secrets", "/tmp", "--grids", "tiles,whole",
                               "--grid-hz", "4", "--clouds", "none", "--grid-mb", "5"});
  ASSERT_TRUE(options) << options.error();
  EXPECT_EQ(options->offers.offer_of(0).grids, GridForm::Tiles);
  EXPECT_EQ(options->offers.offer_of(1).grids, GridForm::Whole);
  EXPECT_EQ(options->offers.offer_of(2).grids, GridForm::Tiles);
  EXPECT_EQ(options->offers.offer_of(2).grid_every.count(), 0.25);
  EXPECT_EQ(options->offers.offer_of(2).grid_bytes, 5'000'000u);
  EXPECT_TRUE(options->offers.has_grids());
  EXPECT_FALSE(options->offers.has_clouds());
}

TEST(TeamToken, IsTheOnlyLineOfItsFile) {
  const std::filesystem::path folder = testing::TempDir() + "adit_robots_token_" + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  const std::pair<const char*, bool> cases[] = {{"flux230{showroom", true},
                                                {"flux230{showroom\r\n", true},
                                                {"", false},
                                                {"\n", false},
                                                {"two words", false}};
  for (const auto& [text, good] : cases) {
    std::ofstream(folder / "team.token") << text << std::flush;
    const auto token = read_token(folder / "team.token");
    EXPECT_EQ(token.has_value(), good) << text;
    if (good) {
      EXPECT_EQ(*token, "flux230{showroom");
    }
  }
  std::filesystem::remove_all(folder);
  EXPECT_FALSE(read_token(folder / "team.token"));
}

}  // namespace
}  // namespace adit::robots
