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

enum class Command : std::uint8_t { Status, Reports, Run, Network, Test, Check, Help };

/// What `adit reports` is to do.
enum class Verb : std::uint8_t { List, Show, Export, Send, Withdraw, Done, Resubmit };

/// adit's command line.
struct Options {
  Command command = Command::Help;
  Command about = Command::Help;  // of Help: the command to explain
  Verb verb = Verb::List;
  std::string word;                   // of Network: "show", "confirm", "back"
  std::vector<std::int64_t> numbers;  // of reports
  std::optional<std::int64_t> run;    // whose reports to list; nothing: the present one's
  bool all_runs = false;
  bool json = false, csv = false;
  std::string at;  // "ADDR:PORT"; empty: as the settings say
  std::string settings = "/etc/adit/settings.json";
  std::string token_file;  // empty: in `secrets`
  std::string secrets = kSecrets;
};

/// What is wrong names the word it is about.
std::expected<Options, std::string> parse_options(std::span<const std::string_view> words);

}  // namespace adit::cli
