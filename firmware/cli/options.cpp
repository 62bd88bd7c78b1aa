#include "cli/options.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

namespace adit::cli {
namespace {

using Words = std::span<const std::string_view>;

struct CommandName {
  std::string_view name;
  Command command;
};
constexpr CommandName kCommands[] = {
    {"status", Command::Status},     {"reports", Command::Reports},   {"aside", Command::Aside},
    {"run", Command::Run},           {"settings", Command::Settings}, {"course", Command::Course},
    {"identify", Command::Identify}, {"network", Command::Network},   {"test", Command::Test},
    {"update", Command::Update},     {"check", Command::Check},       {"help", Command::Help}};

struct VerbName {
  std::string_view name;
  Verb verb;
  std::size_t least, most;  // numbers of reports
};
constexpr std::size_t kMany = 1000;
constexpr std::int64_t kLongestIdentify = 60;  // seconds
constexpr VerbName kVerbs[] = {{"", Verb::List, 0, 0},         {"show", Verb::Show, 1, 1},
                               {"export", Verb::Export, 0, 0}, {"send", Verb::Send, 1, kMany},
                               {"hold", Verb::Hold, 1, kMany}, {"withdraw", Verb::Withdraw, 1, kMany},
                               {"done", Verb::Done, 1, kMany}, {"resubmit", Verb::Resubmit, 1, 1}};

struct SettingName {
  std::string_view name;
  Setting setting;
  bool wants_file;
};
constexpr SettingName kSettings[] = {{"show", Setting::Show, false},
                                     {"check", Setting::Check, true},
                                     {"apply", Setting::Apply, true},
                                     {"export", Setting::Export, false}};

template <class Row>
const Row* named(std::span<const Row> table, std::string_view word) {
  const auto found = std::ranges::find(table, word, &Row::name);
  return found == table.end() ? nullptr : &*found;
}

const VerbName& row_of(Verb verb) {
  return *std::ranges::find(kVerbs, verb, &VerbName::verb);
}

/// Whether the command line, as it was understood, has a use for the option.
bool takes(const Options& options, std::string_view option) {
  const bool lists = options.command == Command::Reports && options.verb == Verb::List;
  const bool exports = options.command == Command::Reports && options.verb == Verb::Export;
  if (option == "--at" || option == "--token-file") return options.command != Command::Check;
  if (option == "--run") return lists;
  if (option == "--csv") return exports;
  if (option == "--restart" || option == "--stick") return options.command == Command::Update;
  if (option == "--again")
    return options.command == Command::Update && (options.stick || !options.file.empty());
  if (option == "--anyway") return options.command == Command::Update && options.restart;
  return true;
}

std::optional<std::int64_t> number_in(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size() && number > 0;
  return whole ? std::optional(number) : std::nullopt;
}

/// Takes the words one by one.
class Parser {
 public:
  explicit Parser(Words words) : words_(words) {}

  std::expected<Options, std::string> parse() {
    while (!words_.empty() && trouble_.empty()) take(next());
    if (trouble_.empty() && !help_) finish();
    if (!trouble_.empty()) return std::unexpected(trouble_);
    if (help_) options_.about = std::exchange(options_.command, Command::Help);
    return options_;
  }

 private:
  std::string_view next() {
    const std::string_view word = words_.front();
    words_ = words_.subspan(1);
    return word;
  }

  void take(std::string_view word) {
    if (word.starts_with('-')) return take_option(word);
    if (!commanded_ || (help_ && options_.command == Command::Help)) return take_command(word);
    switch (options_.command) {
      case Command::Reports:
        return take_word_of_reports(word);
      case Command::Run:
        return run_new_ || word != "new" ? too_many(word) : void(run_new_ = true);
      case Command::Settings:
        return take_word_of_settings(word);
      case Command::Course:
        return std::exchange(coursed_, true) ? too_many(word) : void(options_.course = word);
      case Command::Identify:
        return take_seconds(word);
      case Command::Network:
        return take_word_of_network(word);
      case Command::Aside:
        return take_word_of_aside(word);
      case Command::Update:
        return options_.file.empty() ? void(options_.file = word) : too_many(word);
      case Command::Check:
        return std::exchange(filed_, true) ? too_many(word) : void(options_.settings = word);
      default:
        return too_many(word);
    }
  }

  void take_option(std::string_view word) {
    given_.push_back(word);
    if (word == "--help" || word == "-h") {
      help_ = true;
    } else if (word == "--json") {
      options_.json = true;
    } else if (word == "--csv") {
      options_.csv = true;
    } else if (word == "--restart") {
      options_.restart = true;
    } else if (word == "--stick") {
      options_.stick = true;
    } else if (word == "--again") {
      options_.again = true;
    } else if (word == "--anyway") {
      options_.anyway = true;
    } else if (word == "--at") {
      take_value(word, options_.at);
    } else if (word == "--settings") {
      take_value(word, options_.settings);
    } else if (word == "--token-file") {
      take_value(word, options_.token_file);
    } else if (word == "--run") {
      take_run();
    } else {
      refuse("no such option: ", word);
    }
  }

  void take_value(std::string_view option, std::string& value) {
    if (words_.empty() || words_.front().empty()) return refuse("a value is missing after ", option);
    value = next();
  }

  void take_run() {
    std::string value;
    take_value("--run", value);
    if (!trouble_.empty()) return;
    options_.run = number_in(value);
    options_.all_runs = value == "all";
    if (!options_.run && !options_.all_runs) refuse("expected --run and a run's number or all, got ", value);
  }

  void take_seconds(std::string_view word) {
    if (std::exchange(timed_, true)) return too_many(word);
    const auto seconds = number_in(word);
    if (!seconds || *seconds > kLongestIdentify) {
      return refuse("expected seconds, a whole number from 1 to 60, got ", word);
    }
    options_.seconds = *seconds;
  }

  void take_command(std::string_view word) {
    const auto* row = named<CommandName>(kCommands, word);
    if (row == nullptr) return refuse("no such command: ", word);
    help_ = help_ || row->command == Command::Help;
    commanded_ = true;
    options_.command = row->command;
  }

  void take_word_of_network(std::string_view word) {
    if (!options_.word.empty()) return too_many(word);
    if (word != "show" && word != "confirm" && word != "back")
      return refuse("expected show, confirm or back, got ", word);
    options_.word = word;
  }

  void take_word_of_aside(std::string_view word) {
    if (options_.word.empty()) {
      if (word != "show" && word != "send" && word != "discard")
        return refuse("expected show, send or discard, got ", word);
      options_.word = word;
      return;
    }
    const auto number = number_in(word);
    if (options_.word == "show" || options_.numbers.size() == kMany) return too_many(word);
    if (!number) return refuse("expected the number of what is set aside, got ", word);
    options_.numbers.push_back(*number);
  }

  void take_word_of_reports(std::string_view word) {
    if (options_.verb == Verb::List) {
      const auto* row = named<VerbName>(kVerbs, word);
      if (row == nullptr || row->verb == Verb::List) {
        return refuse("expected show, send, hold, withdraw, done, resubmit or export, got ", word);
      }
      options_.verb = row->verb;
      return;
    }
    const auto number = number_in(word);
    if (options_.numbers.size() == row_of(options_.verb).most) return too_many(word);
    if (!number) return refuse("expected a report's number, got ", word);
    options_.numbers.push_back(*number);
  }

  void take_word_of_settings(std::string_view word) {
    if (setting_ == nullptr) {
      setting_ = named<SettingName>(kSettings, word);
      if (setting_ == nullptr) return refuse("expected show, check, apply or export, got ", word);
      options_.setting = setting_->setting;
    } else if (!setting_->wants_file || !options_.file.empty()) {
      too_many(word);
    } else {
      options_.file = word;
    }
  }

  void finish() {
    if (!commanded_) {
      return refuse(
          "a command is missing: status, reports, aside, run, settings, course, identify, network, test, "
          "update or "
          "check",
          "");
    }
    const auto useless =
        std::ranges::find_if_not(given_, [this](std::string_view option) { return takes(options_, option); });
    if (useless != given_.end()) return refuse(spoken() + " does not take ", *useless);
    if (options_.csv && options_.json) return refuse("--csv and --json are two formats: which one?", "");
    if (options_.command == Command::Run && !run_new_) return refuse("a word is missing: run new", "");
    if (options_.command == Command::Course && !coursed_) return refuse("a course's name is missing", "");
    if (setting_ != nullptr && setting_->wants_file && options_.file.empty()) {
      return refuse("a file is missing after ", setting_->name);
    }
    if (int{options_.stick} + int{options_.restart} +
            int{options_.command == Command::Update && !options_.file.empty()} >
        1)
      return refuse("a file, --stick and --restart are three things: which one?", "");
    const bool shows = options_.command == Command::Network || options_.command == Command::Aside;
    if (shows && options_.word.empty()) options_.word = "show";
    if (options_.command == Command::Aside && options_.word != "show" && options_.numbers.empty()) {
      return refuse("the number of what is set aside is missing after ", options_.word);
    }
    if (options_.numbers.size() < row_of(options_.verb).least) {
      refuse("a report's number is missing after ", row_of(options_.verb).name);
    }
  }

  /// "reports send"
  std::string spoken() const {
    const auto command = std::ranges::find(kCommands, options_.command, &CommandName::command);
    std::string words(command->name);
    if (setting_ != nullptr) words.append(" ").append(setting_->name);
    if (options_.verb != Verb::List) words.append(" ").append(row_of(options_.verb).name);
    return words;
  }

  void too_many(std::string_view word) { refuse("one word too many: ", word); }
  void refuse(std::string_view what, std::string_view word) { trouble_ = std::string(what).append(word); }

  Words words_;
  Options options_;
  std::vector<std::string_view> given_;   // options
  const SettingName* setting_ = nullptr;  // as it was said
  bool commanded_ = false, filed_ = false, timed_ = false, run_new_ = false, coursed_ = false, help_ = false;
  std::string trouble_;
};

}  // namespace

std::expected<Options, std::string> parse_options(Words words) {
  return Parser(words).parse();
}

}  // namespace adit::cli
