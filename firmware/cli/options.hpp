#pragma once

#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/token.hpp"
#include "command_line/program.hpp"
#include "settings/settings.hpp"

namespace adit::cli {

/// What aditd is given with the box, and what it keeps that was saved since and then counts.
inline constexpr const char* kGivenSettings = "/etc/adit/settings.json";
inline constexpr const char* kSavedSettings = "/var/lib/adit/settings.json";

/// The values that a test tries instead of the present settings; "": the present one.
struct Trial {
  std::string course;
  std::optional<settings::Address> scoring, mapping;
  std::string scoring_token, mapping_token;  // files

  bool is_of_what_is_in_use() const {
    return course.empty() && !scoring && !mapping && scoring_token.empty() && mapping_token.empty();
  }
};

struct CommandRow;
struct Form;

/// adit's command line.
struct Options {
  const CommandRow* command = nullptr;  // null: the line names none; of help, the command to explain
  const Form* form = nullptr;           // its subcommand; null: of help and version
  bool help = false, version = false;
  std::vector<std::int64_t> numbers;   // the arguments of a form that takes numbers
  std::vector<std::string> arguments;  // of any other form
  std::optional<std::int64_t> run;     // whose reports to list; nothing: the present one's
  bool all_runs = false;
  std::optional<std::int64_t> last;  // how many reports to list; nothing: all
  bool json = false, csv = false;
  bool yes = false;  // do not ask for confirmation
  std::string at;    // "ADDR[:PORT]"; empty: as the settings say
  std::string to;    // of runs: the file for its report; "": standard output
  bool restart = false, stick = false, again = false, anyway = false, back = false,
       stay = false;  // of update; stick: of spare, too
  std::string code;   // of spare: of the export
  Trial trial;        // of test
  std::string settings = kGivenSettings;
  std::string saved_settings = kSavedSettings;
  std::string token_file;  // empty: in `secrets`
  std::string secrets = kSecrets, saved_secrets = kSavedSecrets;

  /// The argument at that place; "" if it is not given.
  std::string argument(std::size_t place = 0) const {
    return place < arguments.size() ? arguments[place] : "";
  }
  /// The word of the form: "send" of `adit reports send`.
  std::string word() const;
};

[[gnu::cold]] command_line::Program command_line_of(Options& options);
/// Whether an option is one of `options`, which blanks divide.
bool is_among(std::string_view option, std::string_view options);
/// Whether the form takes the option.
bool takes(const Form& form, std::string_view option);

/// Why a command line is wrong.
struct WrongLine {
  std::string sentence;       // names the word it is about
  const CommandRow* command;  // the command that the line named, or null
};

[[gnu::cold]] std::expected<Options, WrongLine> parse_options(std::span<const std::string_view> words);

}  // namespace adit::cli
