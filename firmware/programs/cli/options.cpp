#include "cli/options.hpp"

#include <algorithm>
#include <utility>

#include "cli/ask.hpp"
#include "cli/commands.hpp"
#include "codec/row.hpp"
#include "command_line/read.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/suggestion.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::cli {

std::expected<Token, std::string> token_in_file(const std::string& file) {
  const auto text = ADIT_TRY(host::read_file(file));
  auto token = icd::BearerToken::parse_file(text);
  if (!token) return std::unexpected(file + ": expected one token of 1 to 256 visible ASCII characters");
  return Token{std::move(*token), file};
}

std::expected<std::optional<Token>, std::string> find_token(const std::string& file,
                                                            std::span<const std::string> folders) {
  if (!file.empty()) return token_in_file(file);
  for (const char* name : {"/team.token", "/scoring.token"}) {
    for (const std::string& folder : folders) {
      const std::string path = folder + name;
      if (!host::can_exist(path)) continue;
      const auto text = host::read_file(path);
      if (!text)
        return std::unexpected(text.error() +
                               "; run adit as root, or name a token file by --token-file FILE");
      const bool is_saved = &folder == &folders.front();
      if (is_saved || !icd::trim(*text).empty()) return token_in_file(path);
    }
  }
  return std::nullopt;
}

namespace {

using command_line::Wrong;

std::optional<std::int64_t> number_in(std::string_view text, std::int64_t largest) {
  const auto number = icd::number_in<std::int64_t>(text);
  return number && *number > 0 && *number <= largest ? number : std::nullopt;
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
    if (!row.forms.empty()) names.emplace_back(row.name);
  }
  return names;
}

/// Reads the words that are not options.
class Words {
 public:
  explicit Words(Options& options) : options_(options) {}

  [[gnu::cold]] Wrong add_word(const std::string& word) {
    if (options_.command == nullptr) return set_command(word);
    if (options_.form == nullptr && !words_of(*options_.command).empty()) return set_form(word);
    if (options_.form == nullptr) options_.form = options_.command->forms.data();
    return add_argument(word);
  }

  /// `given`: the options.
  [[gnu::cold]] Wrong finish(std::span<const std::string> given) {
    const CommandRow* const command = options_.command;
    const Form*& form = options_.form;
    if (options_.version || options_.help) return std::nullopt;
    if (command == nullptr) return "a command is missing: " + codec::list_alternatives(names_of_commands());
    if (form == nullptr && !command->forms.front().usual)
      return "a subcommand is missing after " + command_text() + ": " +
             codec::list_alternatives(words_of(*command));
    const std::string spoken = this->command_text();
    if (form == nullptr) form = command->forms.data();
    for (const std::string& option : given) {
      if (!accepts_option(*form, option)) return spoken + " does not take " + option;
    }
    if (count_ < form->argument.least) return missing_argument();
    return disagreement();
  }

 private:
  Wrong set_command(std::string_view word) {
    const auto row = std::ranges::find(commands(), word, &CommandRow::name);
    if (row == commands().end())
      return std::string("no such command: ").append(word) + icd::did_you_mean(word, names_of_commands());
    if (row->forms.empty()) {
      options_.help = true;
    } else {
      options_.command = &*row;
    }
    return std::nullopt;
  }

  Wrong set_form(const std::string& word) {
    for (const Form& form : options_.command->forms) {
      if (word.empty() || word != form.word) continue;
      options_.form = &form;
      return std::nullopt;
    }
    const auto words = words_of(*options_.command);
    return "expected " + codec::list_alternatives(words) + ", got " + word + icd::did_you_mean(word, words);
  }

  Wrong add_argument(const std::string& word) {
    const Argument& argument = options_.form->argument;
    if (count_ == argument.most) return "one word too many: " + word;
    ++count_;
    if (argument.largest == 0) {
      options_.arguments.push_back(word);
      return std::nullopt;
    }
    const auto number = number_in(word, argument.largest);
    if (!number) return std::string("expected ") + argument.noun + ", got " + word;
    options_.numbers.push_back(*number);
    return std::nullopt;
  }

  Wrong missing_argument() const {
    const std::string missing = std::string(options_.form->argument.noun) + " is missing";
    return options_.word().empty() ? missing : missing + " after " + options_.word();
  }

  /// The error about two options that exclude each other.
  Wrong disagreement() const {
    if (options_.csv && options_.json) return "give --csv or --json, not both";
    if (options_.command->name == std::string_view("spare")) return spare_disagreement();
    if (options_.command->name != std::string_view("update")) return std::nullopt;
    const bool has_file = !options_.argument().empty();
    const int asked =
        int{options_.stick} + int{options_.restart} + int{options_.back} + int{options_.stay} + int{has_file};
    if (asked > 1) return "give only one of FILE, --stick, --restart, --back and --stay";
    if (options_.again && !options_.stick && !has_file) return "update does not take --again";
    if (options_.anyway && !options_.restart && !options_.back) return "update does not take --anyway";
    return std::nullopt;
  }

  /// An export is in a local file, or on the box's stick, where a name only selects it.
  Wrong spare_disagreement() const {
    const bool takes_file = options_.form->argument.most > 0, has_file = !options_.argument().empty();
    if (takes_file && !options_.stick && !has_file)
      return "a file or --stick is missing after " + options_.word();
    if (options_.word() == "export" && options_.stick && has_file) return "give FILE or --stick, not both";
    return std::nullopt;
  }

  /// "reports send"
  std::string command_text() const {
    const std::string name = options_.command->name, word = options_.word();
    return word.empty() ? name : name + ' ' + word;
  }

  Options& options_;
  std::size_t count_ = 0;  // of arguments
};

/// Reads an endpoint's address for a test.
template <auto member>
Wrong parse_endpoint(Trial& trial, const std::string& value) {
  auto address = parse_address(value);
  if (!address) return std::move(address.error());
  trial.*member = *std::move(address);
  return std::nullopt;
}

Wrong parse_run(Options& options, const std::string& value) {
  options.run = number_in(value, INT64_MAX);
  options.all_runs = value == "all";
  if (options.run || options.all_runs) return std::nullopt;
  return "expected a run's number or all, got " + value;
}

Wrong parse_last(Options& options, const std::string& value) {
  options.last = number_in(value, INT64_MAX);
  return options.last ? std::nullopt : Wrong("expected a number of reports, got " + value);
}

}  // namespace

std::string Options::word() const {
  return form == nullptr ? "" : form->word;
}

bool is_among(std::string_view option, std::string_view options) {
  return icd::sentence(" ", options, " ").contains(icd::sentence(" ", option, " "));
}

bool accepts_option(const Form& form, std::string_view option) {
  return is_among(option, "--json --settings --help") || is_among(option, form.options) ||
         (form.run.asks != nullptr && is_among(option, "--at --token-file"));
}

command_line::Program command_line_of(Options& options) {
  return {
      .name = "adit",
      .usage = "COMMAND",
      .about = "adit - the command line of a running aditd",
      .rows =
          {{"--run", "N|all", "list the reports of this run; if not given, of the present run",
            command_line::set_by<parse_run>(options)},
           {"--last", "N", "list only the newest N reports", command_line::set_by<parse_last>(options)},
           {"--csv", "", "print CSV, for a spreadsheet (default)", &options.csv},
           {"--yes", "", "do not ask for confirmation; required without a terminal", &options.yes},
           {"--code", "DIGITS", "the export's code, as the first box printed it", &options.code},
           {"--to", "FILE", "write the run's report to FILE instead of standard output", &options.to},
           {"--name", "NAME", "name of the context (default: the address)", &options.name},
           {"--follow", "", "print new records until Ctrl-C", &options.follow},
           {"--level", "LEVEL", "error, warning, notice, info or debug: print only records as bad as this",
            &options.level},
           {"--text", "TEXT", "print only records that contain TEXT", &options.text},
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
            command_line::set_by<parse_endpoint<&Trial::scoring>>(options.trial)},
           {"--mapping", "ADDR[:PORT]", "test this address as the mapping endpoint",
            command_line::set_by<parse_endpoint<&Trial::mapping>>(options.trial)},
           {"--scoring-token", "FILE", "test the token in FILE at the scoring endpoint; it is not saved",
            &options.trial.scoring_token},
           {"--mapping-token", "FILE", "test the token in FILE at the mapping endpoint; it is not saved",
            &options.trial.mapping_token},
           {"--at", "ADDR",
            "Adit's address, name, URL or context; without a port, port 8000 (default: $ADIT_AT, the context "
            "in use, or the settings)",
            &options.at},
           {"--settings", "FILE",
            "read Adit's address from the settings in FILE; saved settings replace the default",
            &options.settings},
           {"--token-file", "FILE",
            "a file with the team's or the scoring token; -: standard input (default: $ADIT_TOKEN_FILE, "
            "$ADIT_TOKEN, the context's, or as root the box's own)",
            &options.token_file},
           {"--json", "", "print JSON, for scripts", &options.json}},
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
  auto program = command_line::full_program(command_line_of, options);
  program.given = &given;
  program.word =
      command_line::set_by<[](Words& all, const std::string& word) { return all.add_word(word); }>(others);
  auto wrong = command_line::read(program, arguments);
  if (!wrong) wrong = others.finish(given);
  if (wrong) return std::unexpected(WrongLine{*std::move(wrong), options.command});
  return options;
}

}  // namespace adit::cli
