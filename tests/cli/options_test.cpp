#include "cli/options.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "cli/commands.hpp"

namespace adit::cli {
namespace {

using Words = std::vector<std::string_view>;

Options parsed(const Words& words) {
  const auto options = parse_options(words);
  EXPECT_TRUE(options.has_value()) << options.error().sentence;
  return options.value_or(Options{});
}

/// "reports send"
std::string command_of(const Options& options) {
  const std::string word = options.word();
  return options.command->name + (word.empty() ? "" : " " + word);
}

const CommandRow* command(std::string_view name) {
  return &*std::ranges::find(commands(), name, &CommandRow::name);
}

TEST(Options, AcceptCommandAndOptionsInAnyOrder) {
  for (const Words& words :
       {Words{"status", "--json", "--at", "10.0.0.1:80"}, {"--at", "10.0.0.1:80", "--json", "status"}}) {
    const Options options = parsed(words);
    EXPECT_EQ(command_of(options), "status");
    EXPECT_TRUE(options.json);
    EXPECT_EQ(options.at, "10.0.0.1:80");
    EXPECT_EQ(options.settings, "/etc/adit/settings.json");
  }
  EXPECT_EQ(parsed({"reports", "--settings", "x.json"}).settings, "x.json");
}

TEST(Options, AcceptTheFileToCheckAsAWord) {
  EXPECT_EQ(parsed({"check", "new.json"}).argument(), "new.json");
  EXPECT_EQ(parsed({"check"}).argument(), "");
}

TEST(Options, AcceptTheOperatorsActions) {
  const Options options = parsed({"reports", "settle", "7", "--token-file", "t", "12"});
  EXPECT_EQ(command_of(options), "reports settle");
  EXPECT_EQ(options.numbers, (std::vector<std::int64_t>{7, 12}));
  EXPECT_EQ(options.token_file, "t");
  for (const char* const verb : {"send", "hold", "withdraw", "resubmit", "show"})
    EXPECT_EQ(parsed({"reports", verb, "7"}).word(), verb);
  EXPECT_EQ(parsed({"run", "new"}).word(), "new");
  EXPECT_EQ(parsed({"run"}).word(), "show");
  EXPECT_EQ(parsed({"identify", "60"}).numbers, std::vector<std::int64_t>{60});
}

TEST(Options, AcceptSelectionAndFormatOfReports) {
  EXPECT_EQ(parsed({"reports"}).run, std::nullopt);
  EXPECT_FALSE(parsed({"reports"}).all_runs);
  EXPECT_EQ(parsed({"reports", "--run", "2"}).run, 2);
  EXPECT_TRUE(parsed({"reports", "--run", "all"}).all_runs);
  EXPECT_EQ(parsed({"reports", "--last", "5"}).last, 5);
  EXPECT_TRUE(parsed({"reports", "export", "--csv"}).csv);
  EXPECT_TRUE(parsed({"reports", "export", "--json"}).json);
}

TEST(Options, AcceptActionsOnTheSettings) {
  EXPECT_EQ(parsed({"settings"}).word(), "show");
  for (const char* const verb : {"show", "export"}) EXPECT_EQ(parsed({"settings", verb}).word(), verb);
  const Options options = parsed({"settings", "apply", "box.json", "--at", "10.0.0.1:80"});
  EXPECT_EQ(command_of(options), "settings apply");
  EXPECT_EQ(options.argument(), "box.json");
  EXPECT_EQ(parsed({"settings", "check", "box.json"}).word(), "check");
  using Arguments = std::vector<std::string>;
  EXPECT_EQ(parsed({"course", "B"}).arguments, Arguments{"B"});
  EXPECT_EQ(parsed({"course", ""}).arguments, Arguments{""});
  EXPECT_EQ(parsed({"course"}).arguments, Arguments{});
  EXPECT_EQ(parsed({"settings", "set", "reports.review", "all"}).arguments,
            (Arguments{"reports.review", "all"}));
}

TEST(Options, NameTheWrongWord) {
  const struct {
    Words words;
    const char* sentence;
  } cases[] = {{{},
                "a command is missing: status, watch, alarms, reports, rejected, run, runs, settings, "
                "tokens, password, course, identify, "
                "network, clock, certificate, test, spare, ledger, update, reset, log, bundle, login, "
                "context, version, "
                "check or complete"},
               {{"--json"},
                "a command is missing: status, watch, alarms, reports, rejected, run, runs, settings, "
                "tokens, password, course, identify, "
                "network, clock, certificate, test, spare, ledger, update, reset, log, bundle, login, "
                "context, version, "
                "check or complete"},
               {{"stat"}, "no such command: stat; did you mean status?"},
               {{"xyzzy"}, "no such command: xyzzy"},
               {{"help", "report"}, "no such command: report; did you mean reports?"},
               {{"status", "--jsn"}, "unknown word '--jsn'; did you mean --json?"},
               {{"status", "--at"}, "--at wants a value"},
               {{"status", "now"}, "one word too many: now"},
               {{"check", "a", "b"}, "one word too many: b"},
               {{"check", "--at", "10.0.0.1:80"}, "check does not take --at"},
               {{"status", "--csv"}, "status does not take --csv"},
               {{"reports", "snd"},
                "expected show, send, hold, withdraw, correct, compose, settle, resubmit or export, got snd; "
                "did you mean "
                "send?"},
               {{"reports", "--yes"}, "reports does not take --yes"},
               {{"reports", "settle", "7", "--yes"}, "reports settle does not take --yes"},
               {{"watch", "7"}, "one word too many: 7"},
               {{"reports", "7"},
                "expected show, send, hold, withdraw, correct, compose, settle, resubmit or export, got 7"},
               {{"reports", "send"}, "a report's number is missing after send"},
               {{"reports", "send", "0"}, "expected a report's number, got 0"},
               {{"reports", "send", "7x"}, "expected a report's number, got 7x"},
               {{"reports", "show", "7", "8"}, "one word too many: 8"},
               {{"reports", "resubmit", "7", "8"}, "one word too many: 8"},
               {{"reports", "export", "7"}, "one word too many: 7"},
               {{"reports", "--csv"}, "reports does not take --csv"},
               {{"settings", "save"}, "expected show, set, check, apply or export, got save"},
               {{"settings", "apply"}, "a file is missing after apply"},
               {{"settings", "apply", "a", "b"}, "one word too many: b"},
               {{"settings", "export", "a"}, "one word too many: a"},
               {{"settings", "--csv"}, "settings does not take --csv"},
               {{"settings", "set", "reports.review"}, "a settings key or its value is missing after set"},
               {{"settings", "set", "a", "b", "c"}, "one word too many: c"},
               {{"course", "A", "B"}, "one word too many: B"},
               {{"check", "--token-file", "x"}, "check does not take --token-file"},
               {{"reports", "show", "7", "--run", "2"}, "reports show does not take --run"},
               {{"reports", "--run", "old"}, "--run: expected a run's number or all, got old"},
               {{"reports", "--run"}, "--run wants a value"},
               {{"reports", "--last", "0"}, "--last: expected a number of reports, got 0"},
               {{"reports", "export", "--last", "5"}, "reports export does not take --last"},
               {{"reports", "export", "--csv", "--json"}, "give --csv or --json, not both"},
               {{"reports", "--to", "x"}, "reports does not take --to"},
               {{"reports", "send", "7", "--token-file", ""}, "--token-file wants a value"},
               {{"complete"},
                "a subcommand is missing after complete: reports, rejected, courses, runs, tokens, alarms, "
                "contexts or keys"},
               {{"run", "old"}, "expected show or new, got old"},
               {{"run", "new", "new"}, "one word too many: new"},
               {{"identify", "0"}, "expected seconds, a whole number from 1 to 60, got 0"},
               {{"identify", "61"}, "expected seconds, a whole number from 1 to 60, got 61"},
               {{"identify", "now"}, "expected seconds, a whole number from 1 to 60, got now"},
               {{"identify", "5", "6"}, "one word too many: 6"}};
  for (const auto& [words, sentence] : cases) {
    const auto options = parse_options(words);
    ASSERT_FALSE(options.has_value()) << sentence;
    EXPECT_EQ(options.error().sentence, sentence);
  }
}

TEST(Options, BelongToTheirCommands) {
  EXPECT_TRUE(parsed({"reports", "send", "7", "--yes"}).yes);
  EXPECT_EQ(parsed({"settings", "show", "reports.review"}).argument(), "reports.review");
  EXPECT_EQ(parsed({"complete", "reports", "settle"}).argument(), "settle");
  EXPECT_EQ(command_of(parsed({"watch", "--json"})), "watch");
  EXPECT_THAT(help_text(command("reports")),
              testing::HasSubstr("without a subcommand: list the reports of this run"));
  EXPECT_THAT(help_text(command("reports")), testing::HasSubstr("with export: print CSV"));
  EXPECT_THAT(help_text(command("reports")), testing::HasSubstr("with send: do not ask"));
}

TEST(Version, IsShownDespiteOtherWords) {
  EXPECT_TRUE(parsed({"--version"}).version);
  for (const Words& words : {Words{"--version"}, {"status", "--version"}}) {
    EXPECT_THAT(run(words).out, testing::MatchesRegex("adit [0-9]+\\.[0-9]+\\.[0-9]+\n"));
    EXPECT_EQ(run(words).exit, Exit::Fine);
  }
}

TEST(Help, IsGivenForTheNamedCommand) {
  for (const Words& words : {Words{"--help"}, {"-h"}, {"help"}})
    EXPECT_EQ(run(words).out, help_text(nullptr));
  for (const Words& words : {Words{"check", "--help"}, {"help", "check"}, {"check", "--at", "x", "-h"}}) {
    EXPECT_EQ(run(words).out, help_text(command("check")));
    EXPECT_EQ(run(words).exit, Exit::Fine);
  }
  EXPECT_EQ(run(Words{"help", "reports"}).out, help_text(command("reports")));
  EXPECT_EQ(run(Words{"reports", "send", "--help"}).out, help_text(command("reports")));
  EXPECT_EQ(run(Words{"help", "run"}).out, help_text(command("run")));
  EXPECT_EQ(run(Words{"help", "identify"}).out, help_text(command("identify")));
  EXPECT_EQ(run(Words{"help", "status"}).out, help_text(command("status")));
}

TEST(Command, WithAFaultNamesItAndTheHelp) {
  const Outcome outcome = run(Words{"st\x1b[2Jatus"});
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "adit: no such command: st\\x1b[2Jatus\nsee \"adit help\"\n");
  EXPECT_EQ(run(Words{"reports", "--csv"}).err,
            "adit: reports does not take --csv\nsee \"adit help reports\"\n");
  EXPECT_THAT(run(Words{"reports", "--nosuch"}).err, testing::EndsWith("\nsee \"adit help reports\"\n"));
}

}  // namespace
}  // namespace adit::cli
