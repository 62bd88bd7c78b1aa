#include "host/command_line.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace adit::host {
namespace {

struct Words {
  std::string folder = "/usual", file = "";
  bool quick = false, help = false, version = false;
};
constexpr Flag<Words> kFlags[] = {
    {"quick", &Words::quick}, {"--help", &Words::help}, {"--version", &Words::version}};
constexpr Value<Words> kValues[] = {{"--folder", &Words::folder}, {"--file", &Words::file}};

std::expected<Words, std::string> read(std::vector<std::string> words, Empty empty = Empty::Refused) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  return read_command_line<Words>(arguments, kFlags, kValues, empty);
}

std::optional<int> exit_of(const std::vector<std::string>& words) {
  return answered("it", "1.2.3", "Usage: it\n", read(words));
}

TEST(ACommandLine, IsReadByItsTables) {
  const auto words = read({"--file", "first", "quick", "--file", "--folder"});
  ASSERT_TRUE(words);
  EXPECT_EQ(words->file, "--folder") << "the last of two counts, and a value may look like a word";
  EXPECT_EQ(words->folder, "/usual");
  EXPECT_TRUE(words->quick);
  EXPECT_FALSE(words->help);
  EXPECT_TRUE(read({}));
}

TEST(ACommandLine, IsRefusedByItsWord) {
  EXPECT_EQ(read({"quick", "slow"}).error(), "unknown word 'slow'");
  EXPECT_EQ(read({""}).error(), "unknown word ''");
  EXPECT_EQ(read({"--fil"}).error(), "unknown word '--fil'");
  EXPECT_EQ(read({"--file"}).error(), "--file wants a value");
  EXPECT_EQ(read({"--folder", ""}).error(), "--folder wants a value");
  EXPECT_EQ(read({"--folder", ""}, Empty::Taken)->folder, "");
}

TEST(ACommandLine, IsAnsweredAtOnceWhereThereIsNoWork) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(exit_of({}), std::nullopt);
  EXPECT_EQ(exit_of({"--help"}), 0);
  EXPECT_EQ(exit_of({"--version"}), 0);
  EXPECT_EQ(exit_of({"--wrong"}), 2);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "Usage: it\nit 1.2.3\n");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "it: unknown word '--wrong'\nUsage: it\n");
}

}  // namespace
}  // namespace adit::host
