#include <algorithm>
#include <deque>

#include "cli/ask.hpp"
#include "cli/commands.hpp"
#include "command_line/read.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::cli {
namespace {

using command_line::Program;
using command_line::Row;

constexpr const char* kUnable =
    "\n  2  if Adit cannot be reached, or the token, a file or the command line is wrong\n";

/// Options of most commands.
constexpr std::string_view kUsual = "--at --settings --token-file --json --version --help";

/// Inserts rows of help text before the options.
void prepend_rows(Program& program, const std::vector<Row>& rows) {
  program.rows.insert(program.rows.begin(), rows.begin(), rows.end());
}

/// Removes options that the command does not take. --settings has another meaning in check.
void limit_to(Program& program, const CommandRow& command) {
  const bool checks = command.name == std::string_view("check");
  std::erase_if(program.rows, [&](const Row& row) {
    return (checks && row.word == std::string_view("--settings")) ||
           std::ranges::none_of(command.forms,
                                [&](const Form& form) { return accepts_option(form, row.word); });
  });
}

/// "with export: " or "without a subcommand: " if only some forms take an option; "" if all do.
std::string forms_with(const CommandRow& command, const char* option) {
  std::string words;
  bool by_all = true;
  for (const Form& form : command.forms) {
    if (!accepts_option(form, option)) {
      by_all = false;
    } else if (*form.word != '\0') {
      words.append(words.empty() ? "" : ", ").append(form.word);
    }
  }
  if (by_all) return "";
  return words.empty() ? "without a subcommand: " : "with " + words + ": ";
}

/// "[show|send]", "[FILE]"
std::string usage_of(const CommandRow& command) {
  std::string words;
  for (const Form& form : command.forms) {
    if (*form.word != '\0') words.append(words.empty() ? "" : "|").append(form.word);
  }
  if (command.forms.front().usual && !words.empty()) words = "[" + words + "]";
  const Form& first = command.forms.front();
  const char* const argument = *first.word == '\0' ? first.argument.shown : "";
  return words.append(words.empty() || *argument == '\0' ? "" : " ").append(argument);
}

void explain_all(Program& program) {
  std::vector<Row> rows;
  for (const CommandRow& row : commands())
    rows.push_back({row.name, "", row.sentence, command_line::ValueSetter()});
  std::erase_if(program.rows, [](const Row& row) { return !is_among(row.word, kUsual); });
  prepend_rows(program, rows);
  program.ending =
      "Exit status:\n  0  if the command succeeded and no alarm needs the operator\n"
      "  1  if an alarm needs the operator, the settings are wrong, or Adit rejected an action";
  program.ending.append(kUnable).append(
      "Environment:\n"
      "  ADIT_AT          used if --at and --settings are not given\n"
      "  ADIT_TOKEN_FILE  used if --token-file is not given\n"
      "  ADIT_TOKEN       the token itself, used if no file is named\n"
      "  NO_COLOR         if set, print without colour\n"
      "Files:\n"
      "  ~/.config/adit/contexts.json  addresses and tokens of adit login, for this user alone\n"
      "  /var/lib/adit/settings.json  the saved settings; without them, /etc/adit/settings.json\n"
      "  /var/lib/adit/secrets        team.token or else scoring.token; without them, /etc/adit/secrets\n"
      "Bugs:\n"
      "  report them at " ADIT_BUGS
      ",\n"
      "  with the file that adit bundle writes");
}

/// `sentences` owns texts that the program's rows refer to.
void explain(Program& program, const CommandRow& command, std::deque<std::string>& sentences) {
  program.name.append(" ").append(command.name);
  program.usage = usage_of(command);
  program.about = program.name + " - " + command.sentence;
  if (*command.details != '\0') program.about.append("\n\n").append(command.details);
  limit_to(program, command);
  for (Row& row : program.rows)
    row.help = sentences.emplace_back(forms_with(command, row.word) + row.help).c_str();
  std::vector<Row> rows;
  for (const Form& form : command.forms) {
    if (*form.word != '\0')
      rows.push_back({form.word, form.argument.shown, form.sentence, command_line::ValueSetter()});
  }
  prepend_rows(program, rows);
  program.ending.append("Exit status:\n  0  if ").append(command.fine);
  if (*command.attention != '\0') program.ending.append("\n  1  if ").append(command.attention);
  program.ending.append(kUnable);
  if (*command.examples != '\0') program.ending.append("\nExamples:\n").append(command.examples);
}

Result<Outcome> outcome_of(const Options& options, const Console& console) {
  const Run& run = options.form->run;
  if (run.alone != nullptr) return run.alone(options, console);
  const auto adit = ADIT_TRY(adit_of(options, console));
  return run.asks({adit, options, console});
}

}  // namespace

std::string see_help(const CommandRow* about) {
  return icd::sentence("see \"adit help", about == nullptr ? "" : " ", about == nullptr ? "" : about->name,
                       "\"\n");
}

std::string help_text(const CommandRow* about) {
  Options options;
  Program program = command_line::full_program(command_line_of, options);
  std::deque<std::string> sentences;
  if (about == nullptr) {
    explain_all(program);
  } else {
    explain(program, *about, sentences);
  }
  return command_line::help(program);
}

Outcome run(const Options& options, const Console& console) {
  const auto outcome = outcome_of(options, console);
  return outcome ? *outcome : failure_outcome(outcome.error());
}

Outcome run(std::span<const std::string_view> words, const Console& console) {
  const auto options = parse_options(words);
  if (!options) {
    const auto& [sentence, command] = options.error();
    return {Exit::Unable, "", "adit: " + host::escape(sentence) + '\n' + see_help(command)};
  }
  if (options->version) return {Exit::Fine, "adit " ADIT_VERSION "\n", ""};
  if (options->help) return {Exit::Fine, help_text(options->command), ""};
  return run(*options, console);
}

}  // namespace adit::cli
