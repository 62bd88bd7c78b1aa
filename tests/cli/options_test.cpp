#include "cli/options.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "cli/command.hpp"
#include "cli/help.hpp"

namespace adit::cli {
namespace {

using Words = std::vector<std::string_view>;

Options parsed(const Words& words) {
  const auto options = parse_options(words);
  EXPECT_TRUE(options.has_value()) << options.error();
  return options.value_or(Options{});
}

TEST(Options, TakeACommandAndItsOptionsInAnyOrder) {
  for (const Words& words :
       {Words{"status", "--json", "--at", "10.0.0.1:80"}, {"--at", "10.0.0.1:80", "--json", "status"}}) {
    const Options options = parsed(words);
    EXPECT_EQ(options.command, Command::Status);
    EXPECT_TRUE(options.json);
    EXPECT_EQ(options.at, "10.0.0.1:80");
    EXPECT_EQ(options.settings, "/etc/adit/settings.json");
  }
  EXPECT_EQ(parsed({"reports", "--settings", "x.json"}).settings, "x.json");
}

TEST(Options, TakeTheFileToCheckAsAWord) {
  EXPECT_EQ(parsed({"check", "new.json"}).settings, "new.json");
  EXPECT_EQ(parsed({"check"}).settings, "/etc/adit/settings.json");
}

TEST(Options, NameTheWordThatIsWrong) {
  const struct {
    Words words;
    const char* sentence;
  } cases[] = {{{}, "a command is missing: status, reports or check"},
               {{"--json"}, "a command is missing: status, reports or check"},
               {{"state"}, "no such command: state"},
               {{"status", "--jsn"}, "no such option: --jsn"},
               {{"status", "--at"}, "a value is missing after --at"},
               {{"status", "now"}, "one word too many: now"},
               {{"check", "a", "b"}, "one word too many: b"},
               {{"check", "--at", "10.0.0.1:80"}, "check does not take --at"}};
  for (const auto& [words, sentence] : cases) {
    const auto options = parse_options(words);
    ASSERT_FALSE(options.has_value()) << sentence;
    EXPECT_EQ(options.error(), sentence);
  }
}

TEST(Help, IsGivenForTheCommandAskedAbout) {
  for (const Words& words : {Words{"--help"}, {"-h"}, {"help"}})
    EXPECT_EQ(run(words, false).out, help_about(Command::Help));
  for (const Words& words : {Words{"check", "--help"}, {"help", "check"}, {"check", "--at", "x", "-h"}}) {
    EXPECT_EQ(run(words, false).out, help_about(Command::Check));
    EXPECT_EQ(run(words, false).exit, Exit::Fine);
  }
  EXPECT_EQ(run(Words{"help", "reports"}, false).out, help_about(Command::Reports));
  EXPECT_EQ(run(Words{"help", "status"}, false).out, help_about(Command::Status));
}

TEST(Command, OfAWrongLineSaysSoAndWhereHelpIs) {
  const Outcome outcome = run(Words{"st\x1b[2Jatus"}, false);
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "adit: no such command: st\\x1b[2Jatus\nTry 'adit --help'.\n");
}

}  // namespace
}  // namespace adit::cli
