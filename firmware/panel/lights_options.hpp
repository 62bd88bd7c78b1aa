#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace adit::panel {

/// adit-lights' command line.
struct LightsOptions {
  enum class Word : std::uint8_t { Fault, Dark, Ended };
  Word word = Word::Dark;
  std::string board;
  std::vector<std::string> settings;  // the first that can be read counts
  std::string simulated;
  std::optional<std::chrono::seconds> seconds;  // nothing: until it is ended
  bool help = false, version = false;
};

extern const char* const kLightsUsage;

/// What is wrong names the word it is about.
std::expected<LightsOptions, std::string> parse_lights_options(std::span<char* const> arguments);

/// Whether a service that ended so ($SERVICE_RESULT of systemd.exec(5); null: not said) has died.
bool has_died(const char* service_result);

}  // namespace adit::panel
