// The panel with libgpiod, of either version.
#include "panel/gpio.hpp"

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "icd/try.hpp"
#include "panel/lines.hpp"

namespace adit::panel {
namespace {

const std::string& line_of(const settings::Panel& settings, Light light) {
  using settings::Panel;
  constexpr std::array kLines = {&Panel::health, &Panel::scoring, &Panel::mapping, &Panel::attention};
  return settings.*kLines[index_of(light)];
}

/// "line H (health) of chip gpiochip0"
std::string describe_line(const settings::Panel& settings, const std::string& line, std::string_view what) {
  const std::string chip = settings.chip.empty() ? " of any chip" : " of chip " + settings.chip;
  return "line " + line + " (" + std::string(what) + ")" + chip;
}

class GpioLines final : public Lines {
 public:
  using Outputs = std::array<std::unique_ptr<GpioLine>, kLights.size()>;

  GpioLines(settings::Panel settings, Outputs outputs)
      : settings_(std::move(settings)), outputs_(std::move(outputs)) {}
  GpioLines(const GpioLines&) = delete;
  GpioLines& operator=(const GpioLines&) = delete;
  ~GpioLines() override {
    for (const auto& output : outputs_) {
      if (output) output->set(false);
    }
  }

  /// Sets every light even if one fails. The error is that of the first failure.
  std::expected<void, std::string> set(const Lit& lit) override {
    std::expected<void, std::string> result;
    for (const Light light : kLights) {
      const auto& output = outputs_[index_of(light)];
      if (!output || output->set(lit[index_of(light)]) == 0) continue;
      if (result)
        result = panel_error(describe_line(settings_, line_of(settings_, light), name_of(light)), errno);
    }
    return result;
  }

 private:
  settings::Panel settings_;
  Outputs outputs_;
};

class GpioButton final : public ButtonLine {
 public:
  GpioButton(std::unique_ptr<GpioLine> line, std::string about)
      : line_(std::move(line)), about_(std::move(about)) {}

  int descriptor() const override { return line_->descriptor(); }

  /// Uses the level, not the edges, because the kernel drops edges during a long bounce.
  std::expected<bool, std::string> is_pressed() override {
    const int value = line_->drop_edges() < 0 ? -1 : line_->get();
    if (value < 0) return panel_error(about_, errno);
    return value == 1;
  }

 private:
  std::unique_ptr<GpioLine> line_;
  std::string about_;
};

}  // namespace

std::unexpected<std::string> panel_error(const std::string& about, int error) {
  return std::unexpected("panel: " + about + ": " + std::system_category().message(error));
}

std::expected<std::unique_ptr<Lines>, std::string> open_gpio(const settings::Panel& settings,
                                                             const std::string& consumer) {
  GpioLines::Outputs outputs;
  for (const Light light : kLights) {
    const std::string& line = line_of(settings, light);
    if (line.empty()) continue;
    outputs[index_of(light)] = ADIT_TRY(request_line({.chip = settings.chip,
                                                      .line = line,
                                                      .about = describe_line(settings, line, name_of(light)),
                                                      .consumer = consumer,
                                                      .active_low = settings.active_low,
                                                      .is_output = true}));
  }
  return std::make_unique<GpioLines>(settings, std::move(outputs));
}

std::expected<std::unique_ptr<ButtonLine>, std::string> open_gpio_button(const settings::Panel& settings,
                                                                         const std::string& consumer) {
  const std::string what = describe_line(settings, settings.button, "button");
  auto line = ADIT_TRY(request_line({.chip = settings.chip,
                                     .line = settings.button,
                                     .about = what,
                                     .consumer = consumer,
                                     .active_low = settings.button_active_low}));
  return std::make_unique<GpioButton>(std::move(line), what);
}

}  // namespace adit::panel
