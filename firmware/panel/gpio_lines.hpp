#pragma once

#include <cerrno>
#include <expected>
#include <string>
#include <system_error>

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

}  // namespace adit::panel
