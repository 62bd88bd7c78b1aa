#include "command_line/program.hpp"

#include <gmock/gmock.h>

#include "command_line/read.hpp"

namespace adit::command_line {
namespace {

using Words = std::vector<const char*>;

struct Options {
  std::string folder = "/usual", file;
  std::vector<std::string> more;
  double speed = 1;
  bool quick = false, help = false, version = false;
};

Program program_of(Options& options) {
  return {.name = "it",
          .usage = "[quick]",
          .about = "Does what it says.\n\n  kept    as it is\nAnd more.",
          .rows = {{"--file", "FILE", "what to do it with", &options.file, Presence::Required},
                   {"--folder", "DIR",
                    "where it is done; and this sentence is so long that it has to go on in a "
                    "second line",
                    &options.folder},
                   {"--more", "FILE", "another", &options.more},
                   {"--speed", "N", "how fast", number<0.5, 2.0>(options.speed)},
                   {"quick", "", "at once", &options.quick}},
          .ending = "Exits 0."};
}

constexpr const char* kHelp =
    "Usage: it --file FILE [quick] [OPTION]...\n"
    "\n"
    "Does what it says.\n"
    "\n"
    "  kept    as it is\n"
    "And more.\n"
    "\n"
    "  --file FILE   what to do it with\n"
    "  --folder DIR  where it is done; and this sentence is so long that it has to go on in a second line\n"
    "                (/usual)\n"
    "  --more FILE   another\n"
    "  --speed N     how fast\n"
    "  quick         at once\n"
    "  --version     print the version\n"
    "  --help        print this help\n"
    "\n"
    "Exits 0.\n";

std::expected<Options, std::string> read(const Words& words) {
  return command_line::read(program_of, words);
}

TEST(CommandLine, IsReadByItsTable) {
  const auto options =
      read({"--file", "first", "quick", "--more=a", "--more", "b", "--speed=1.5", "--file", "--folder"});
  ASSERT_TRUE(options) << options.error();
  EXPECT_EQ(options->file, "--folder") << "the last of two counts, and a value may look like a word";
  EXPECT_EQ(options->folder, "/usual");
  EXPECT_THAT(options->more, testing::ElementsAre("a", "b"));
  EXPECT_EQ(options->speed, 1.5);
  EXPECT_TRUE(options->quick);
  EXPECT_FALSE(options->help);
  EXPECT_EQ(read({"--file=a=b"})->file, "a=b");
  EXPECT_TRUE(read({"--file", "a", "--", "quick"})->quick);
  EXPECT_TRUE(read({"-h"})->help);
}

TEST(CommandLine, IsRejectedWithItsWord) {
  const struct {
    Words words;
    const char* sentence;
  } cases[] = {{{"quick", "slow"}, "unknown word 'slow'"},
               {{""}, "unknown word ''"},
               {{"-"}, "unknown word '-'"},
               {{"-x"}, "unknown word '-x'"},
               {{"--fil", "x"}, "unknown word '--fil'; did you mean --file?"},
               {{"--fil=x"}, "unknown word '--fil'; did you mean --file?"},
               {{"-flie"}, "unknown word '-flie'; did you mean --file?"},
               {{"--f", "x"}, "unknown word '--f'"},
               {{"--fol"}, "unknown word '--fol'; did you mean --folder?"},
               {{"--quick"}, "unknown word '--quick'; did you mean quick?"},
               {{"qick"}, "unknown word 'qick'; did you mean quick?"},
               {{"--other=x"}, "unknown word '--other'"},
               {{"--file"}, "--file wants a value"},
               {{"--folder", ""}, "--folder wants a value"},
               {{"--folder="}, "--folder wants a value"},
               {{"--help=all"}, "--help takes no value"},
               {{"--speed", "3"}, "--speed: expected 0.5 to 2, got '3'"},
               {{"--speed", "nan"}, "--speed: expected 0.5 to 2, got 'nan'"},
               {{"--speed", "1x"}, "--speed: expected 0.5 to 2, got '1x'"},
               {{"quick"}, "--file FILE is missing"}};
  for (const auto& [words, sentence] : cases) {
    const auto options = read(words);
    ASSERT_FALSE(options) << sentence;
    EXPECT_EQ(options.error(), sentence);
  }
}

TEST(CommandLine, MayHaveEmptyValuesAndFreeWords) {
  Options options;
  Program program = program_of(options);
  program.empty = EmptyValue::Accepted;
  std::string words;
  program.word = set_by<[](std::string& all, const std::string& word) -> Wrong {
    all += word;
    return word == "no" ? Wrong("not that") : std::nullopt;
  }>(words);
  EXPECT_EQ(command_line::read(program, Words{"a", "--file", "x", "--folder", "", "b", "--", "--file"}),
            std::nullopt);
  EXPECT_EQ(options.folder, "");
  EXPECT_EQ(words, "ab--file");
  EXPECT_EQ(command_line::read(program, Words{"set", "-1", "--file", "x", "-.5"}), std::nullopt);
  EXPECT_EQ(words, "ab--fileset-1-.5") << "negative numbers are words";
  EXPECT_EQ(command_line::read(program, Words{"no"}), "not that");
  EXPECT_EQ(command_line::read(program, Words{"--file", ""}), "--file FILE is missing");
}

TEST(CommandLine, AnswersHelpVersionAndErrorsAtOnce) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const auto exit_of = [](const Words& words) { return answer(program_of, "1.2.3", read(words)); };
  EXPECT_EQ(exit_of({"--file", "x"}), std::nullopt);
  EXPECT_EQ(exit_of({"--help"}), 0);
  EXPECT_EQ(exit_of({"--version"}), 0);
  EXPECT_EQ(exit_of({"--wrong"}), 2);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), std::string(kHelp) + "it 1.2.3\n");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), std::string("it: unknown word '--wrong'\n") + kHelp);
}

}  // namespace
}  // namespace adit::command_line
