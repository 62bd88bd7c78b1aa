#include "panel/lights_options.hpp"

#include <gtest/gtest.h>

namespace adit::panel {
namespace {

using Word = LightsOptions::Word;

std::expected<LightsOptions, std::string> parse(const std::vector<const char*>& words) {
  return parse_lights_options(words);
}

TEST(LightsOptions, SayWhatToShowWhereAndHowLong) {
  const auto options = parse(
      {"fault", "--board", "b", "--settings", "s", "--settings", "t", "--simulated", "p", "--seconds", "20"});
  ASSERT_TRUE(options) << options.error();
  EXPECT_EQ(options->word, Word::Fault);
  EXPECT_EQ(options->board, "b");
  EXPECT_EQ(options->settings, (std::vector<std::string>{"s", "t"}));
  EXPECT_EQ(options->simulated, "p");
  EXPECT_EQ(options->seconds, std::chrono::seconds(20));
  EXPECT_EQ(parse({"dark"})->word, Word::Dark);
  EXPECT_EQ(parse({"ended"})->word, Word::Ended);
  EXPECT_EQ(parse({"ended"})->seconds, std::nullopt);
}

TEST(LightsOptions, NameWhatIsMissingOrUnknown) {
  EXPECT_EQ(parse({}).error(), "fault, dark or ended is missing");
  EXPECT_EQ(parse({"bright"}).error(), "unknown word 'bright'");
  EXPECT_EQ(parse({"dark", "fault"}).error(), "fault: fault, dark and ended are three things: which one?");
  EXPECT_EQ(parse({"dark", "--bord"}).error(), "unknown word '--bord'; did you mean --board?");
  EXPECT_EQ(parse({"dark", "--board"}).error(), "--board wants a value");
  for (const char* const seconds : {"0", "-1", "3601", "1.5", "ten", ""}) {
    EXPECT_EQ(parse({"fault", "--seconds", seconds}).error(),
              std::string("--seconds: expected 1 to 3600, got '") + seconds + "'");
  }
}

TEST(LightsOptions, HelpAndVersionNeedNothingElse) {
  EXPECT_TRUE(parse({"--help"})->help);
  EXPECT_TRUE(parse({"--version"})->version);
}

TEST(ServiceResult, IsADeathInAllCasesButSuccess) {
  for (const char* result :
       {"exit-code", "signal", "core-dump", "watchdog", "timeout", "oom-kill", "protocol"}) {
    EXPECT_TRUE(has_died(result)) << result;
  }
  EXPECT_FALSE(has_died("success"));
  EXPECT_FALSE(has_died(nullptr));
}

}  // namespace
}  // namespace adit::panel
