#include <gpiod.h>

#include <cerrno>
#include <system_error>

#include "panel/panel.hpp"

namespace adit::panel {
namespace {

constexpr const char* kConsumer = "aditd";  // what gpioinfo(1) shows as the line's user

std::unexpected<std::string> trouble(const std::string& about, int error) {
  return std::unexpected("panel: " + about + ": " + std::system_category().message(error));
}

struct CloseChip {
  void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

/// A line that is an output of this program's, and dark; it is dark again when let go.
struct LetGo {
  void operator()(gpiod_line* line) const {
    gpiod_line_set_value(line, 0);
    gpiod_line_release(line);
  }
};
using Line = std::unique_ptr<gpiod_line, LetGo>;

const std::string& line_of(const settings::Panel& settings, Light light) {
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

class GpioLines final : public Lines {
 public:
  GpioLines(settings::Panel settings, Chip chip) : settings_(std::move(settings)), chip_(std::move(chip)) {}

  std::expected<void, std::string> request(Light light) {
    const std::string& name = line_of(settings_, light);
    if (name.empty()) return {};
    errno = 0;
    gpiod_line* line = gpiod_chip_find_line(chip_.get(), name.c_str());
    if (line == nullptr) return trouble(about(light), errno == 0 ? ENOENT : errno);
    const int flags = settings_.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
    if (gpiod_line_request_output_flags(line, kConsumer, flags, 0) != 0) return trouble(about(light), errno);
    lines_[static_cast<std::size_t>(light)].reset(line);
    return {};
  }

  /// Every light is set, also after one that fails; the first failure is told.
  std::expected<void, std::string> set(const std::array<bool, kLights.size()>& lit) override {
    std::expected<void, std::string> result;
    for (const Light light : kLights) {
      const auto index = static_cast<std::size_t>(light);
      if (!lines_[index]) continue;
      if (gpiod_line_set_value(lines_[index].get(), lit[index] ? 1 : 0) != 0 && result) {
        result = trouble(about(light), errno);
      }
    }
    return result;
  }

 private:
  std::string about(Light light) const {
    return "line " + line_of(settings_, light) + " (" + std::string(name_of(light)) + ") of chip " +
           settings_.chip;
  }

  settings::Panel settings_;
  Chip chip_;
  std::array<Line, kLights.size()> lines_;  // after chip_: let go before the chip is closed
};

}  // namespace

std::expected<std::unique_ptr<Lines>, std::string> open_gpio(const settings::Panel& settings) {
  Chip chip(gpiod_chip_open_lookup(settings.chip.c_str()));
  if (!chip) return trouble("chip " + settings.chip, errno);
  auto lines = std::make_unique<GpioLines>(settings, std::move(chip));
  for (const Light light : kLights) {
    if (auto requested = lines->request(light); !requested) return std::unexpected(requested.error());
  }
  return lines;
}

}  // namespace adit::panel
