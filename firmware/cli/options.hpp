#pragma once

#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.hpp"
#include "cli/token.hpp"
#include "command_line/program.hpp"
#include "settings/settings.hpp"

namespace adit::cli {

/// What aditd is given with the box, and what it keeps that was saved since and then counts.
inline constexpr const char* kGivenSettings = "/etc/adit/settings.json";
inline constexpr const char* kSavedSettings = "/var/lib/adit/settings.json";

/// What a Test is to try instead of what is in use; "": nothing.
struct Trial {
  std::string course;
  std::optional<settings::Address> scoring, mapping;
  std::string scoring_token, mapping_token;  // files

  bool is_of_what_is_in_use() const {
    return course.empty() && !scoring && !mapping && scoring_token.empty() && mapping_token.empty();
  }
};

/// adit's command line.
struct Options {
  Command command = Command::Help;
  Command about = Command::Help;  // of Help: the command to explain
  bool help = false, version = false;
  Verb verb = Verb::List;
  std::vector<std::int64_t> numbers;  // of reports, or of rejected messages
  std::optional<std::int64_t> run;    // whose reports to list; nothing: the present one's
  bool all_runs = false;
  std::optional<std::int64_t> last;  // how many reports to list; nothing: all
  std::int64_t seconds = 10;         // how long the lights are to blink
  bool json = false, csv = false;
  bool yes = false;     // what is asked on a terminal is meant
  std::string at;       // "ADDR[:PORT]"; empty: as the settings say
  std::string file;     // of settings: to check or apply; of Update: the bundle; of Spare: the export; of
                        // Ledger: its directory
  std::string key;      // of settings show, or where several begin; of settings set
  std::string value;    // of settings set
  std::string word;     // of Complete: of `adit reports`
  std::string run_key;  // of Runs
  std::string to;       // of Runs: the file for its report; "": standard output
  bool restart = false, stick = false, again = false, anyway = false, back = false,
       stay = false;                  // of Update; stick: of Spare, too
  std::string code;                   // of Spare: of the export; "": it is asked for
  std::optional<std::string> course;  // to switch to; "": the endpoints of command_post
  Trial trial;                        // of Test
  std::string settings = kGivenSettings;
  std::string saved_settings = kSavedSettings;
  std::string token_file;  // empty: in `secrets`
  std::string secrets = kSecrets, saved_secrets = kSavedSecrets;
};

[[gnu::cold]] command_line::Program command_line_of(Options& options);
/// Whether a command, as it was said, has a use for the option.
bool takes(const CommandRow& command, const Form& form, std::string_view option);

/// Why a command line is wrong.
struct WrongLine {
  std::string sentence;             // names the word it is about
  Command command = Command::Help;  // the command that the line named
};

[[gnu::cold]] std::expected<Options, WrongLine> parse_options(std::span<const std::string_view> words);

}  // namespace adit::cli
