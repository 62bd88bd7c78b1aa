#include "panel/held.hpp"

#include <utility>

#include "panel/reopened.hpp"

namespace adit::panel {
namespace {

std::unique_ptr<Lines> hold_lines(const settings::Panel& settings, const std::string& consumer,
                                  const std::string& simulated_file) {
  const auto make = [simulated_file] { return simulated_file.empty() ? nullptr : simulated(simulated_file); };
  if (settings.is_simulated()) return make();
  return reopened_lines([settings, consumer] { return open_gpio(settings, consumer); }, make);
}

/// A simulated button never replaces a real one, because it would not prove that a person is at the box.
std::expected<std::unique_ptr<ButtonLine>, std::string> hold_button(const settings::Panel& settings,
                                                                    const std::string& consumer,
                                                                    const std::string& simulated_file) {
  if (settings.is_simulated()) {
    if (simulated_file.empty()) return nullptr;
    return simulated_button(simulated_file + ".button");
  }
  if (settings.button.empty()) return nullptr;
  return reopened_button([settings, consumer] { return open_gpio_button(settings, consumer); });
}

}  // namespace

Held hold(const settings::Panel& settings, const std::string& consumer, const std::string& simulated,
          const std::function<void(const std::string&)>& complain) {
  auto button = hold_button(settings, consumer, simulated);
  if (!button) complain("cannot use the button: " + button.error());
  return {hold_lines(settings, consumer, simulated), button ? std::move(*button) : nullptr};
}

}  // namespace adit::panel
