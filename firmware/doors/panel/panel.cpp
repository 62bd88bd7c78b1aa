#include "panel/panel.hpp"

#include <algorithm>
#include <numeric>

namespace adit::panel {
namespace {

using namespace std::chrono_literals;

// A blink is a whole number of steps and begins lit. "Slow" to "fast" is one to four, "rush" is too fast to
// count, "flash" is mostly dark, "wink" mostly lit.
constexpr Step kOffSteps[] = {{false, 1s}};
constexpr Step kOnSteps[] = {{true, 1s}};
constexpr Step kSlowSteps[] = {{true, 500ms}, {false, 500ms}};
constexpr Step kFastSteps[] = {{true, 125ms}, {false, 125ms}};
constexpr Step kTwiceSteps[] = {{true, 125ms}, {false, 125ms}, {true, 125ms}, {false, 625ms}};
constexpr Step kFlashSteps[] = {{true, 125ms}, {false, 1875ms}};
constexpr Step kWinkSteps[] = {{true, 1750ms}, {false, 250ms}};
constexpr Step kRushSteps[] = {{true, 50ms}, {false, 50ms}};

struct PatternRow {
  std::string_view name;
  std::span<const Step> steps;
};
/// In the order of Pattern.
constexpr PatternRow kPatternRows[] = {{"off", kOffSteps},   {"on", kOnSteps},       {"slow", kSlowSteps},
                                       {"fast", kFastSteps}, {"twice", kTwiceSteps}, {"flash", kFlashSteps},
                                       {"wink", kWinkSteps}, {"rush", kRushSteps},   {"digits", {}}};
static_assert(std::size(kPatternRows) == kPatterns.size());

}  // namespace

std::string_view name_of(Light light) {
  static constexpr std::array<std::string_view, kLights.size()> kNames = {"health", "scoring", "mapping",
                                                                          "attention"};
  return kNames[index_of(light)];
}

std::string_view name_of(Pattern pattern) {
  return kPatternRows[static_cast<std::size_t>(pattern)].name;
}

std::span<const Step> steps_of(Pattern pattern) {
  return kPatternRows[static_cast<std::size_t>(pattern)].steps;
}

Milliseconds length_of(std::span<const Step> steps) {
  return std::accumulate(steps.begin(), steps.end(), Milliseconds{0},
                         [](Milliseconds sum, const Step& step) { return sum + step.length; });
}

Moment single_moment(std::span<const Step> steps, Milliseconds elapsed) {
  for (const Step& step : steps) {
    if (elapsed < step.length) return {step.lit, step.length - elapsed};
    elapsed -= step.length;
  }
  return {};
}

Moment repeated_moment(std::span<const Step> steps, Milliseconds elapsed) {
  if (steps.empty()) return {};
  if (steps.size() == 1) return {steps.front().lit, std::nullopt};
  return single_moment(steps, elapsed % length_of(steps));
}

Frame frame_of(const Lights& lights, Milliseconds elapsed) {
  Frame frame;
  for (const Light light : kLights) {
    const Moment moment = repeated_moment(steps_of(lights[index_of(light)]), elapsed);
    frame.lit[index_of(light)] = moment.lit;
    if (moment.lasts) frame.lasts = std::min(*moment.lasts, frame.lasts.value_or(*moment.lasts));
  }
  return frame;
}

}  // namespace adit::panel
