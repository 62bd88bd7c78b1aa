#pragma once

#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "command_line/program.hpp"
#include "icd/bearer_token.hpp"
#include "settings/settings.hpp"

namespace adit::cli {

/// Directories of adit.service's given tokens and of its saved ones.
inline constexpr const char* kSecrets = "/etc/adit/secrets";
inline constexpr const char* kSavedSecrets = "/var/lib/adit/secrets";

/// A token and its file.
struct Token {
  icd::BearerToken token;
  std::string file;
};

/// Reads the token in a file. An error names the file, never its content.
std::expected<Token, std::string> token_in_file(const std::string& file);

/// The token in `file`. If `file` is "", the first of team.token and scoring.token in `folders`, each in the
/// first directory (the saved tokens) first; std::nullopt if there is none. An empty file is no token, except
/// in the first directory. An error names the file, never its content: the file cannot be read, or holds no
/// token.
std::expected<std::optional<Token>, std::string> find_token(const std::string& file,
                                                            std::span<const std::string> folders);

/// aditd's given settings, and the saved ones, which precede them.
inline constexpr const char* kGivenSettings = "/etc/adit/settings.json";
inline constexpr const char* kSavedSettings = "/var/lib/adit/settings.json";

/// Values that a test uses instead of the present settings; "": the present one.
struct Trial {
  std::string course;
  std::optional<settings::Address> scoring, mapping;
  std::string scoring_token, mapping_token;  // files

  bool is_for_current_settings() const {
    return course.empty() && !scoring && !mapping && scoring_token.empty() && mapping_token.empty();
  }
};

struct CommandRow;
struct Form;

struct Options {
  const CommandRow* command = nullptr;  // null: not named; of help: the command to explain
  const Form* form = nullptr;           // the subcommand; null for help and version
  bool help = false, version = false;
  std::vector<std::int64_t> numbers;   // arguments of a form with numbers
  std::vector<std::string> arguments;  // arguments of other forms
  std::optional<std::int64_t> run;     // of the listed reports; nullopt: the present run
  bool all_runs = false;
  std::optional<std::int64_t> last;  // most listed reports; nullopt: all
  bool json = false, csv = false;
  bool yes = false;         // skip the confirmation
  std::string at;           // "ADDR[:PORT]"; "": from the settings
  std::string to;           // of runs: the report's file; "": standard output
  std::string name;         // of login: the context's; "": the address
  bool follow = false;      // of log
  std::string level, text;  // of log: only records as bad as `level`, or that contain `text`
  bool restart = false, stick = false, again = false, anyway = false, back = false,
       stay = false;  // of update; stick: also of spare
  std::string code;   // of spare: the export's code
  Trial trial;        // of test
  std::string settings = kGivenSettings;
  std::string saved_settings = kSavedSettings;
  std::string token_file;  // "": from `secrets`
  std::string secrets = kSecrets, saved_secrets = kSavedSecrets;

  /// The argument at `place`, or "".
  std::string argument(std::size_t place = 0) const {
    return place < arguments.size() ? arguments[place] : "";
  }
  /// The form's word: "send" of `adit reports send`.
  std::string word() const;
};

[[gnu::cold]] command_line::Program command_line_of(Options& options);
/// Whether an option is one of `options`, which are separated by blanks.
bool is_among(std::string_view option, std::string_view options);
/// Whether the form takes the option.
bool accepts_option(const Form& form, std::string_view option);

struct WrongLine {
  std::string sentence;       // names the wrong word
  const CommandRow* command;  // the line's command, or null
};

[[gnu::cold]] std::expected<Options, WrongLine> parse_options(std::span<const std::string_view> words);

}  // namespace adit::cli
