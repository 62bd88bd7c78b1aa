#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <memory>
#include <string>
#include <string_view>

#include "settings/settings.hpp"

namespace adit::panel {

enum class Light : std::uint8_t { Health, Scoring, Mapping, Attention };
inline constexpr std::array kLights = {Light::Health, Light::Scoring, Light::Mapping, Light::Attention};
std::string_view name_of(Light light);  // "health", ...

/// How a light shows: steady off, steady on, or a blink that can be told apart without colour.
enum class Pattern : std::uint8_t {
  Off,
  On,
  Slow /* 1 Hz */,
  Fast /* 4 Hz */,
  Twice /* two flashes a second */
};
std::string_view name_of(Pattern pattern);  // "off", "on", "slow", "fast", "twice"

using Lights = std::array<Pattern, kLights.size()>;  // by Light

/// What the panel is to tell.
struct Condition {
  bool serving = false;  // the team's side listens and the ledger can be written
  bool scoring_connected = false;
  bool scoring_failing = false;  // the last request to scoring failed or was refused
  bool mapping_connected = false;
  bool mapping_failing = false;
  bool report_waiting = false;
  bool needs_operator = false;  // a report in doubt, a damaged ledger, a token refused
};

/// The table of which condition shows as what: see README.md beside this file.
Lights lights_for(const Condition& condition);

/// What no condition shows: all lights flash twice a second, together, so that one box can be told from
/// others.
inline constexpr Lights kIdentify = {Pattern::Twice, Pattern::Twice, Pattern::Twice, Pattern::Twice};

/// Whether a light with this pattern is lit `elapsed_ms` after the panel started.
bool lit(Pattern pattern, std::uint64_t elapsed_ms);

/// The lines that lights hang on: the seam between the panel and GPIO.
class Lines {
 public:
  virtual ~Lines() = default;
  /// Sets all lights. An error is told once by its sentence; the rest of Adit goes on.
  virtual std::expected<void, std::string> set(const std::array<bool, kLights.size()>& lit) = 0;
};

/// The lines named in the settings, by libgpiod. Lines without a name are left out. All are let go, dark, at
/// the end.
std::expected<std::unique_ptr<Lines>, std::string> open_gpio(const settings::Panel& settings);

/// A panel without GPIO: what it shows is readable from `file` ("health on\n..."), rewritten atomically at
/// each change.
std::unique_ptr<Lines> simulated(std::string file);

}  // namespace adit::panel
