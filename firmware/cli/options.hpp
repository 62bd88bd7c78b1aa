#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/token.hpp"

namespace adit::cli {

enum class Command : std::uint8_t {
  Status,
  Reports,
  Aside,
  Run,
  Settings,
  Course,
  Identify,
  Network,
  Test,
  Update,
  Check,
  Help
};

/// What `adit reports` is to do.
enum class Verb : std::uint8_t { List, Show, Export, Send, Hold, Withdraw, Done, Resubmit };

/// What `adit settings` is to do.
enum class Setting : std::uint8_t { Show, Check, Apply, Export };

/// What aditd is given with the box, and what it keeps that was saved since and then counts.
inline constexpr const char* kGivenSettings = "/etc/adit/settings.json";
inline constexpr const char* kSavedSettings = "/var/lib/adit/settings.json";

/// adit's command line.
struct Options {
  Command command = Command::Help;
  Command about = Command::Help;  // of Help: the command to explain
  Verb verb = Verb::List;
  std::string word;  // of Network: "show", "confirm", "back"; of Aside: "show", "send", "discard"
  std::vector<std::int64_t> numbers;  // of reports, or of what is set aside
  std::optional<std::int64_t> run;    // whose reports to list; nothing: the present one's
  bool all_runs = false;
  std::int64_t seconds = 10;  // how long the lights are to blink
  bool json = false, csv = false;
  std::string at;  // "ADDR:PORT"; empty: as the settings say
  Setting setting = Setting::Show;
  std::string file;  // of settings: to check or apply; of Update: the bundle
  bool restart = false, stick = false, again = false, anyway = false;  // of Update
  std::string course;                                                  // to switch to; "": none
  std::string settings = kGivenSettings;
  std::string saved_settings = kSavedSettings;
  std::string token_file;  // empty: in `secrets`
  std::string secrets = kSecrets, saved_secrets = kSavedSecrets;
};

/// What is wrong names the word it is about.
std::expected<Options, std::string> parse_options(std::span<const std::string_view> words);

}  // namespace adit::cli
