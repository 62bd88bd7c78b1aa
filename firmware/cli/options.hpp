#pragma once

#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <string_view>

namespace adit::cli {

enum class Command : std::uint8_t { Status, Reports, Check, Help };

/// adit's command line.
struct Options {
  Command command = Command::Help;
  Command about = Command::Help;  // of Help: the command to explain
  bool json = false;
  std::string at;  // "ADDR:PORT"; empty: as the settings say
  std::string settings = "/etc/adit/settings.json";
};

/// What is wrong names the word it is about.
std::expected<Options, std::string> parse_options(std::span<const std::string_view> words);

}  // namespace adit::cli
