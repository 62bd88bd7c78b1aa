#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "cli/run_adit.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

double time_of_here() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string clock_view(double now, const char* source, bool is_set, const char* refusal = "") {
  return Server::ok(R"({"now":)" + std::to_string(now) + R"(,"managed":true,"why":"","source":")" + source +
                    R"(","is_set":)" + (is_set ? "true" : "false") + R"(,"refusal":")" + refusal +
                    R"(","ntp":"","is_kept":false})");
}

TEST(ClockCommand, ShowsTheTimeOfDayAndItsSource) {
  const Server server({{"GET /adit/clock", clock_view(time_of_here(), "command_post", true)}});
  const Outcome outcome = run_adit(server, {"clock"});
  EXPECT_EQ(outcome.exit, Exit::Fine);
  EXPECT_THAT(outcome.out,
              HasSubstr("UTC, the same as on this computer\nset by the Command Post's answers\n"));
  EXPECT_THAT(run_adit(server, {"clock", "--json"}).out, HasSubstr("\"source\":\"command_post\""));
}

TEST(ClockCommand, TellsHowToSetTheClock) {
  const Server server({{"GET /adit/clock", clock_view(time_of_here() - 7300, "last_known", false)}});
  const Outcome outcome = run_adit(server, {"clock", "show"});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_THAT(outcome.out, HasSubstr("behind this computer"));
  EXPECT_THAT(outcome.out, HasSubstr("adit clock set"));
}

TEST(ClockCommand, TellsWhyTheClockWasNotSet) {
  const Server server(
      {{"GET /adit/clock", clock_view(time_of_here(), "none", false, "cannot set the clock: no")}});
  EXPECT_THAT(run_adit(server, {"clock"}).out, HasSubstr("Not set: cannot set the clock: no"));
}

TEST(ClockCommand, SetsTheTimeOfThisComputer) {
  const Server server({{"POST /adit/clock", clock_view(time_of_here(), "operator", true)}});
  const Outcome outcome = run_adit(server, {"clock", "set"});
  EXPECT_EQ(outcome.exit, Exit::Fine);
  EXPECT_EQ(outcome.out, "the clock is being set\n");
}

}  // namespace
}  // namespace adit::cli
