// The panel with libgpiod 1.
#include <gpiod.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "icd/try.hpp"
#include "panel/lines.hpp"

namespace adit::panel {
namespace {

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

/// "line H (health) of chip gpiochip0"
std::string about(const settings::Panel& settings, const std::string& line, std::string_view what) {
  const std::string chip = settings.chip.empty() ? " of any chip" : " of chip " + settings.chip;
  return "line " + line + " (" + std::string(what) + ")" + chip;
}

std::unexpected<std::string> gpio_trouble(const std::string& about, int error) {
  return std::unexpected("panel: " + about + ": " + std::system_category().message(error));
}

/// errno as libgpiod left it. libgpiod leaves 0 if it did not find the line or chip.
int gpio_error() {
  return errno == 0 ? ENOENT : errno;
}

struct CloseChip {
  void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

struct Found {
  Chip chip;  // outlives the line
  gpiod_line* line = nullptr;
};

/// `about` describes the line in an error.
std::expected<Found, std::string> find(const settings::Panel& settings, const std::string& name,
                                       const std::string& about) {
  errno = 0;
  if (settings.chip.empty()) {
    gpiod_line* const line = gpiod_line_find(name.c_str());  // opens the chip, which the caller then owns
    if (line == nullptr) return gpio_trouble(about, gpio_error());
    return Found{Chip(gpiod_line_get_chip(line)), line};
  }
  Chip chip(gpiod_chip_open_lookup(settings.chip.c_str()));
  if (!chip) return gpio_trouble("chip " + settings.chip, gpio_error());
  errno = 0;
  gpiod_line* const line = gpiod_chip_find_line(chip.get(), name.c_str());
  if (line == nullptr) return gpio_trouble(about, gpio_error());
  return Found{std::move(chip), line};
}

struct LetGoDark {
  void operator()(gpiod_line* line) const {
    gpiod_line_set_value(line, 0);
    gpiod_line_release(line);
  }
};
/// An output, dark at first and when it is let go.
struct Output {
  Chip chip;  // outlives the line
  std::unique_ptr<gpiod_line, LetGoDark> line;
};

/// `about` describes the line in an error.
std::expected<Output, std::string> request_output(const settings::Panel& settings, const std::string& line,
                                                  const std::string& about, const std::string& consumer) {
  auto found = ADIT_TRY(find(settings, line, about));
  const int flags = settings.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  if (gpiod_line_request_output_flags(found.line, consumer.c_str(), flags, 0) != 0) {
    return gpio_trouble(about, errno);
  }
  return Output{std::move(found.chip), std::unique_ptr<gpiod_line, LetGoDark>(found.line)};
}

class GpioLines final : public Lines {
 public:
  using Outputs = std::array<Output, kLights.size()>;

  GpioLines(settings::Panel settings, Outputs outputs)
      : settings_(std::move(settings)), outputs_(std::move(outputs)) {}

  /// Sets every light even if one fails. The error is that of the first failure.
  std::expected<void, std::string> set(const Lit& lit) override {
    std::expected<void, std::string> result;
    for (const Light light : kLights) {
      gpiod_line* const line = outputs_[index_of(light)].line.get();
      if (line == nullptr || gpiod_line_set_value(line, lit[index_of(light)] ? 1 : 0) == 0) continue;
      if (result) result = gpio_trouble(about(settings_, line_of(settings_, light), name_of(light)), errno);
    }
    return result;
  }

 private:
  settings::Panel settings_;
  Outputs outputs_;
};

class GpioButton final : public ButtonLine {
 public:
  GpioButton(Found found, std::string about) : found_(std::move(found)), about_(std::move(about)) {}
  GpioButton(const GpioButton&) = delete;
  GpioButton& operator=(const GpioButton&) = delete;
  ~GpioButton() override { gpiod_line_release(found_.line); }

  int descriptor() const override { return gpiod_line_event_get_fd(found_.line); }

  /// Uses the level, not the events, because the kernel drops events during a long bounce.
  std::expected<bool, std::string> pressed() override {
    constexpr timespec kNow{};
    std::array<gpiod_line_event, 16> events{};
    int waiting = 0;
    while ((waiting = gpiod_line_event_wait(found_.line, &kNow)) > 0) {
      const int read = gpiod_line_event_read_multiple(found_.line, events.data(), events.size());
      if (read < 0) return gpio_trouble(about_, errno);
    }
    const int value = waiting < 0 ? -1 : gpiod_line_get_value(found_.line);
    if (value < 0) return gpio_trouble(about_, errno);
    return value == 1;
  }

 private:
  Found found_;
  std::string about_;
};

}  // namespace

std::expected<std::unique_ptr<Lines>, std::string> open_gpio(const settings::Panel& settings,
                                                             const std::string& consumer) {
  GpioLines::Outputs outputs;
  for (const Light light : kLights) {
    const std::string& line = line_of(settings, light);
    if (line.empty()) continue;
    auto output = ADIT_TRY(request_output(settings, line, about(settings, line, name_of(light)), consumer));
    outputs[index_of(light)] = std::move(output);
  }
  return std::make_unique<GpioLines>(settings, std::move(outputs));
}

std::expected<std::unique_ptr<ButtonLine>, std::string> open_gpio_button(const settings::Panel& settings,
                                                                         const std::string& consumer) {
  const std::string what = about(settings, settings.button, "button");
  auto found = ADIT_TRY(find(settings, settings.button, what));
  const int flags = settings.button_active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  const int pull = settings.button_active_low ? GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP
                                              : GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
  const auto request = [&](int with) {
    return gpiod_line_request_both_edges_events_flags(found.line, consumer.c_str(), flags | with) == 0;
  };
  if (!request(pull) && !request(0)) return gpio_trouble(what, errno);  // some chips have no pull
  return std::make_unique<GpioButton>(std::move(found), what);
}

std::string gpiod_version() {
  return gpiod_version_string();
}

}  // namespace adit::panel
