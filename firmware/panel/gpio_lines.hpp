#pragma once

#include <array>
#include <cerrno>
#include <expected>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "panel/lines.hpp"
#include "panel/panel.hpp"
#include "settings/settings.hpp"

/// What gpio_v1.cpp and gpio_v2.cpp, for libgpiod 1 and 2, have in common.
namespace adit::panel {

inline const std::string& line_of(const settings::Panel& settings, Light light) {
  switch (light) {
    case Light::Health:
      return settings.health;
    case Light::Scoring:
      return settings.scoring;
    case Light::Mapping:
      return settings.mapping;
    case Light::Attention:
      break;
  }
  return settings.attention;
}

/// "line H (health) of chip gpiochip0"
inline std::string about(const settings::Panel& settings, const std::string& line, std::string_view what) {
  const std::string chip = settings.chip.empty() ? " of any chip" : " of chip " + settings.chip;
  return "line " + line + " (" + std::string(what) + ")" + chip;
}

inline std::unexpected<std::string> gpio_trouble(const std::string& about, int error) {
  return std::unexpected("panel: " + about + ": " + std::system_category().message(error));
}

/// What is left in errno by libgpiod, which says nothing where it merely did not find something.
inline int gpio_error() {
  return errno == 0 ? ENOENT : errno;
}

/// The lights as lines. `Output` is one of them by either library: `is_there()`, and `set(bool)`, which says
/// whether it could and leaves errno where not.
template <class Output>
class GpioLines final : public Lines {
 public:
  using Outputs = std::array<Output, kLights.size()>;

  GpioLines(settings::Panel settings, Outputs outputs)
      : settings_(std::move(settings)), outputs_(std::move(outputs)) {}

  /// Every light is set, also after one that fails; the first failure is told.
  std::expected<void, std::string> set(const Lit& lit) override {
    std::expected<void, std::string> result;
    for (const Light light : kLights) {
      Output& output = outputs_[index_of(light)];
      if (!output.is_there() || output.set(lit[index_of(light)])) continue;
      if (result) result = gpio_trouble(about(settings_, line_of(settings_, light), name_of(light)), errno);
    }
    return result;
  }

 private:
  settings::Panel settings_;
  Outputs outputs_;
};

/// The lights that have a line; `request(line, about)` is std::expected<Output, std::string>.
template <class Output>
std::expected<std::unique_ptr<Lines>, std::string> open_lines(const settings::Panel& settings, auto request) {
  typename GpioLines<Output>::Outputs outputs;
  for (const Light light : kLights) {
    const std::string& line = line_of(settings, light);
    if (line.empty()) continue;
    std::expected<Output, std::string> output = request(line, about(settings, line, name_of(light)));
    if (!output) return std::unexpected(output.error());
    outputs[index_of(light)] = std::move(*output);
  }
  return std::make_unique<GpioLines<Output>>(settings, std::move(outputs));
}

}  // namespace adit::panel
