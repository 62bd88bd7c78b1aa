#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace adit::panel {

using Milliseconds = std::chrono::milliseconds;

enum class Light : std::uint8_t { Health, Scoring, Mapping, Attention };
inline constexpr std::array kLights = {Light::Health, Light::Scoring, Light::Mapping, Light::Attention};
std::string_view name_of(Light light);  // "health", ...
inline constexpr std::size_t index_of(Light light) {
  return static_cast<std::size_t>(light);
}

/// How a light shows. Patterns can be told apart without colour; README.md draws them.
enum class Pattern : std::uint8_t { Off, On, Slow, Fast, Twice, Flash, Wink, Rush, Digits };
inline constexpr std::array kPatterns = {Pattern::Off,  Pattern::On,    Pattern::Slow,
                                         Pattern::Fast, Pattern::Twice, Pattern::Flash,
                                         Pattern::Wink, Pattern::Rush,  Pattern::Digits};
std::string_view name_of(Pattern pattern);  // "off", "on", "slow", ...

/// Lit or dark for a time.
struct Step {
  bool lit = false;
  Milliseconds length{};
  friend bool operator==(const Step&, const Step&) = default;
};

/// The steps that a pattern repeats. One step: steady. Empty for Digits, which are made from an address and
/// played once (states.hpp).
std::span<const Step> steps_of(Pattern pattern);

/// The state of a sequence of steps at one time.
struct Moment {
  bool lit = false;
  std::optional<Milliseconds> lasts;  // until the next step; nullopt: for ever
};
/// The state `elapsed` after the start of repeated steps. Dark if `steps` is empty.
Moment repeated_moment(std::span<const Step> steps, Milliseconds elapsed);
/// The same for steps that are played once, and dark afterwards.
Moment single_moment(std::span<const Step> steps, Milliseconds elapsed);
Milliseconds length_of(std::span<const Step> steps);

using Lights = std::array<Pattern, kLights.size()>;  // by Light
using Lit = std::array<bool, kLights.size()>;        // by Light

/// All lights at one time.
struct Frame {
  Lit lit{};
  std::optional<Milliseconds> lasts;  // until one changes; nullopt: for ever
};
/// The lights `elapsed` after the start of all patterns. They start together, so that lights of one pattern
/// flash together. Digits stay dark.
Frame frame_of(const Lights& lights, Milliseconds elapsed);

}  // namespace adit::panel
