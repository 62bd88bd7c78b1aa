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

/// How a light shows. Each can be told from the others without colour: README.md draws them.
enum class Pattern : std::uint8_t { Off, On, Slow, Fast, Twice, Flash, Wink, Rush, Digits };
inline constexpr std::array kPatterns = {Pattern::Off,  Pattern::On,    Pattern::Slow,
                                         Pattern::Fast, Pattern::Twice, Pattern::Flash,
                                         Pattern::Wink, Pattern::Rush,  Pattern::Digits};
std::string_view name_of(Pattern pattern);  // "off", "on", "slow", ...

/// Lit or dark for so long.
struct Step {
  bool lit = false;
  Milliseconds length{};
  friend bool operator==(const Step&, const Step&) = default;
};

/// What a pattern repeats for ever; one step: steady. None for Digits, which are played once and made of an
/// address (address_digits.hpp).
std::span<const Step> steps_of(Pattern pattern);

/// Where a sequence of steps stands.
struct Moment {
  bool lit = false;
  std::optional<Milliseconds> lasts;  // until the next step; nothing: for ever
};
/// `elapsed` after its first step began, while it is repeated; dark where there is none.
Moment repeated(std::span<const Step> steps, Milliseconds elapsed);
/// The same of steps that are played once, and dark after them.
Moment once(std::span<const Step> steps, Milliseconds elapsed);
Milliseconds length_of(std::span<const Step> steps);

using Lights = std::array<Pattern, kLights.size()>;  // by Light
using Lit = std::array<bool, kLights.size()>;        // by Light

/// All lights at one moment.
struct Frame {
  Lit lit{};
  std::optional<Milliseconds> lasts;  // until one changes; nothing: for ever
};
/// `elapsed` after the patterns began, which they did together so that lights of one pattern flash together.
/// Digits stay dark.
Frame frame_of(const Lights& lights, Milliseconds elapsed);

}  // namespace adit::panel
