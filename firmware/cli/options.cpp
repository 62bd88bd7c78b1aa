#include "cli/options.hpp"

#include <optional>
#include <utility>

namespace adit::cli {
namespace {

std::optional<Command> command_named(std::string_view word) {
  if (word == "status") return Command::Status;
  if (word == "reports") return Command::Reports;
  if (word == "check") return Command::Check;
  if (word == "help") return Command::Help;
  return std::nullopt;
}

/// Takes the words one by one.
class Parser {
 public:
  explicit Parser(std::span<const std::string_view> words) : words_(words) {}

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
    if (word == "--help" || word == "-h") {
      help_ = true;
    } else if (word == "--json") {
      options_.json = true;
    } else if (word == "--at") {
      take_value(word, options_.at);
    } else if (word == "--settings") {
      take_value(word, options_.settings);
    } else if (word.starts_with('-')) {
      refuse("no such option: ", word);
    } else {
      take_plain(word);
    }
  }

  void take_value(std::string_view option, std::string& value) {
    if (words_.empty()) return refuse("a value is missing after ", option);
    value = next();
  }

  void take_plain(std::string_view word) {
    const auto command = command_named(word);
    const bool asks_about = help_ && options_.command == Command::Help;
    if (!commanded_ && !command) return refuse("no such command: ", word);
    if (command && (!commanded_ || asks_about)) {
      help_ = help_ || *command == Command::Help;
      commanded_ = true;
      options_.command = *command;
    } else if (options_.command == Command::Check && !filed_) {
      filed_ = true;
      options_.settings = word;
    } else {
      refuse("one word too many: ", word);
    }
  }

  void finish() {
    if (!commanded_) return refuse("a command is missing: status, reports or check", "");
    if (options_.command == Command::Check && !options_.at.empty()) refuse("check does not take ", "--at");
  }

  void refuse(std::string_view what, std::string_view word) { trouble_ = std::string(what).append(word); }

  std::span<const std::string_view> words_;
  Options options_;
  bool commanded_ = false, filed_ = false, help_ = false;
  std::string trouble_;
};

}  // namespace

std::expected<Options, std::string> parse_options(std::span<const std::string_view> words) {
  return Parser(words).parse();
}

}  // namespace adit::cli
