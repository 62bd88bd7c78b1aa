#pragma once

#include <chrono>

#include "command_line/read.hpp"

namespace adit::panel {

/// adit-lights' command line.
struct LightsOptions {
  enum class Word : std::uint8_t { Fault, Dark, Ended };
  std::optional<Word> word;  // nothing: only help or the version is wanted
  std::string board;
  std::vector<std::string> settings;  // the first that can be read counts
  std::string simulated;
  std::optional<std::chrono::seconds> seconds;  // nothing: until it is ended
  bool help = false, version = false;
};

[[gnu::cold]] command_line::Program lights_command_line_of(LightsOptions& options);

/// What is wrong names the word it is about.
[[gnu::cold]] std::expected<LightsOptions, std::string> parse_lights_options(
    std::span<const char* const> arguments);

/// Whether a service that ended so ($SERVICE_RESULT of systemd.exec(5); null: not said) has died.
bool has_died(const char* service_result);

}  // namespace adit::panel
