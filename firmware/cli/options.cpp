#include "cli/options.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "cli/where.hpp"
#include "codec/row.hpp"
#include "command_line/read.hpp"
#include "spelling/nearest.hpp"

namespace adit::cli {
namespace {

using command_line::Wrong;

std::optional<std::int64_t> number_in(std::string_view text, std::int64_t largest) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size() && number > 0;
  return whole && number <= largest ? std::optional(number) : std::nullopt;
}

std::vector<std::string_view> words_of(const CommandRow& command) {
  std::vector<std::string_view> words;
  for (const Form& form : command.forms) {
    if (*form.word != '\0') words.emplace_back(form.word);
  }
  return words;
}

std::vector<std::string_view> names_of_commands() {
  std::vector<std::string_view> names;
  for (const CommandRow& row : commands()) {
    if (row.command != Command::Help) names.emplace_back(row.name);
  }
  return names;
}

/// Takes the words that are no options, one by one.
class Words {
 public:
  explicit Words(Options& options) : options_(options) {}

  [[gnu::cold]] Wrong take(const std::string& word) {
    if (command_ == nullptr || command_->command == Command::Help) return take_command(word);
    if (form_ == nullptr && !words_of(*command_).empty()) return take_form(word);
    if (form_ == nullptr) form_ = command_->forms.data();
    return take_argument(word);
  }

  /// Help, if the line named no command.
  Command command() const { return command_ == nullptr ? Command::Help : command_->command; }

  /// `given`: the options.
  [[gnu::cold]] Wrong finish(std::span<const std::string> given) {
    if (options_.version) return std::nullopt;
    if (options_.help || helps_) {
      if (command_ != nullptr) options_.about = command_->command;
      return std::nullopt;
    }
    if (command_ == nullptr) return "a command is missing: " + codec::in_turn(names_of_commands());
    options_.command = command_->command;
    const std::string spoken = this->spoken();
    if (form_ == nullptr && !command_->forms.front().usual)
      return "a subcommand is missing after " + spoken + ": " + codec::in_turn(words_of(*command_));
    if (form_ == nullptr) form_ = command_->forms.data();
    options_.verb = form_->verb;
    for (const std::string& option : given) {
      if (!takes(*command_, *form_, option)) return spoken + " does not take " + option;
    }
    if (count_ < form_->argument.least) return missing_argument();
    return disagreement();
  }

 private:
  Wrong take_command(std::string_view word) {
    const auto row = std::ranges::find(commands(), word, &CommandRow::name);
    if (row == commands().end())
      return std::string("no such command: ").append(word) +
             spelling::did_you_mean(word, names_of_commands());
    command_ = &*row;
    helps_ = helps_ || row->command == Command::Help;
    return std::nullopt;
  }

  Wrong take_form(const std::string& word) {
    for (const Form& form : command_->forms) {
      if (word.empty() || word != form.word) continue;
      form_ = &form;
      return std::nullopt;
    }
    const auto words = words_of(*command_);
    return "expected " + codec::in_turn(words) + ", got " + word + spelling::did_you_mean(word, words);
  }

  Wrong take_argument(const std::string& word) {
    const Argument& argument = form_->argument;
    if (count_ == argument.most) return "one word too many: " + word;
    ++count_;
    if (argument.largest == 0) {
      text() = word;
      return std::nullopt;
    }
    const auto number = number_in(word, argument.largest);
    if (!number) return std::string("expected ") + argument.noun + ", got " + word;
    options_.numbers.push_back(*number);
    if (command_->command == Command::Identify) options_.seconds = *number;
    return std::nullopt;
  }

  std::string& text() {
    if (command_->command == Command::Course) return options_.course.emplace();
    if (command_->command == Command::Complete) return options_.word;
    if (command_->command == Command::Runs) return options_.run_key;
    if (form_->argument.among == Among::Keys) return count_ == 1 ? options_.key : options_.value;
    return command_->command == Command::Check ? options_.settings : options_.file;
  }

  Wrong missing_argument() const {
    const std::string missing = std::string(form_->argument.noun) + " is missing";
    return *form_->word == '\0' ? missing : missing + " after " + form_->word;
  }

  /// Two options of which the command takes only one.
  Wrong disagreement() const {
    if (options_.csv && options_.json) return "give --csv or --json, not both";
    if (command_->command == Command::Spare) return spare_disagreement();
    if (command_->command != Command::Update) return std::nullopt;
    const int asked = int{options_.stick} + int{options_.restart} + int{options_.back} + int{options_.stay} +
                      int{!options_.file.empty()};
    if (asked > 1) return "give only one of FILE, --stick, --restart, --back and --stay";
    if (options_.again && !options_.stick && options_.file.empty()) return "update does not take --again";
    if (options_.anyway && !options_.restart && !options_.back) return "update does not take --anyway";
    return std::nullopt;
  }

  /// An export is in a file here, or on the box's stick, where the file is named only to tell it from others.
  Wrong spare_disagreement() const {
    const bool takes_file = options_.verb == Verb::Export || options_.verb == Verb::Take;
    if (takes_file && !options_.stick && options_.file.empty())
      return "a file or --stick is missing after " + std::string(form_->word);
    if (options_.verb == Verb::Export && options_.stick && !options_.file.empty())
      return "give FILE or --stick, not both";
    return std::nullopt;
  }

  /// "reports send"
  std::string spoken() const {
    std::string words = command_->name;
    if (form_ != nullptr && *form_->word != '\0') words.append(" ").append(form_->word);
    return words;
  }

  Options& options_;
  const CommandRow* command_ = nullptr;
  const Form* form_ = nullptr;
  std::size_t count_ = 0;  // of arguments
  bool helps_ = false;     // by the command help
};

/// An endpoint's address, to be tried.
template <auto member>
Wrong take_endpoint(Trial& trial, const std::string& value) {
  auto address = parse_address(value);
  if (!address) return std::move(address.error());
  trial.*member = *std::move(address);
  return std::nullopt;
}

Wrong take_run(Options& options, const std::string& value) {
  options.run = number_in(value, INT64_MAX);
  options.all_runs = value == "all";
  if (options.run || options.all_runs) return std::nullopt;
  return "expected a run's number or all, got " + value;
}

Wrong take_last(Options& options, const std::string& value) {
  options.last = number_in(value, INT64_MAX);
  return options.last ? std::nullopt : Wrong("expected a number of reports, got " + value);
}

}  // namespace

bool takes(const CommandRow& command, const Form& form, std::string_view option) {
  if (option == "--json" || option == "--settings" || option == "--help") return true;
  if (option == "--version") return command.command == Command::Help;
  if (option == "--at" || option == "--token-file")
    return command.command != Command::Check && form.verb != Verb::Dump;
  return form.options.contains(option);
}

command_line::Program command_line_of(Options& options) {
  return {
      .name = "adit",
      .usage = "COMMAND",
      .about = "adit - the command line of a running aditd",
      .rows = {{"--run", "N|all", "list the reports of this run; if not given, of the present run",
                command_line::take<take_run>(options)},
               {"--last", "N", "list only the newest N reports", command_line::take<take_last>(options)},
               {"--csv", "", "print CSV, for a spreadsheet (default)", &options.csv},
               {"--yes", "", "do not ask for confirmation; required without a terminal", &options.yes},
               {"--code", "DIGITS", "the export's code, as the first box printed it", &options.code},
               {"--to", "FILE", "write the run's report to FILE instead of standard output", &options.to},
               {"--stick", "", "use the USB stick in the box instead of FILE", &options.stick},
               {"--restart", "",
                "restart into the installed update. Rejected while a report is queued or being sent",
                &options.restart},
               {"--back", "",
                "if an unexpected slot runs: restart into the slot that was good last. Rejected as --restart",
                &options.back},
               {"--stay", "", "if an unexpected slot runs: keep it", &options.stay},
               {"--anyway", "",
                "with --restart or --back: restart at once. No report is lost; a report being sent is then "
                "in doubt",
                &options.anyway},
               {"--again", "", "install the version that already runs", &options.again},
               {"--course", "NAME", "test this course's Command Post", &options.trial.course},
               {"--scoring", "ADDR[:PORT]", "test this address as the scoring endpoint",
                command_line::take<take_endpoint<&Trial::scoring>>(options.trial)},
               {"--mapping", "ADDR[:PORT]", "test this address as the mapping endpoint",
                command_line::take<take_endpoint<&Trial::mapping>>(options.trial)},
               {"--scoring-token", "FILE", "test the token in FILE at the scoring endpoint; it is not saved",
                &options.trial.scoring_token},
               {"--mapping-token", "FILE", "test the token in FILE at the mapping endpoint; it is not saved",
                &options.trial.mapping_token},
               {"--at", "ADDR[:PORT]",
                "Adit's address; without a port, port 8000 (default: $ADIT_AT, or the settings)",
                &options.at},
               {"--settings", "FILE",
                "read Adit's address from the settings in FILE; saved settings replace the default",
                &options.settings},
               {"--token-file", "FILE",
                "a file with the team's or the scoring token (default: $ADIT_TOKEN_FILE, or as root the "
                "box's own)",
                &options.token_file},
               {"--json", "", "print JSON, for scripts", &options.json},
               {"--version", "", "print the version", &options.version},
               {"--help", "", "print this help", &options.help}},
      .ending = "",
  };
}

std::expected<Options, WrongLine> parse_options(std::span<const std::string_view> words) {
  const std::vector<std::string> texts(words.begin(), words.end());
  std::vector<const char*> arguments;
  arguments.reserve(texts.size());
  for (const std::string& text : texts) arguments.push_back(text.c_str());
  Options options;
  Words others(options);
  std::vector<std::string> given;
  auto program = command_line_of(options);
  program.given = &given;
  program.word =
      command_line::take<[](Words& all, const std::string& word) { return all.take(word); }>(others);
  auto wrong = command_line::read(program, arguments);
  if (!wrong) wrong = others.finish(given);
  if (wrong) return std::unexpected(WrongLine{*std::move(wrong), others.command()});
  return options;
}

}  // namespace adit::cli
