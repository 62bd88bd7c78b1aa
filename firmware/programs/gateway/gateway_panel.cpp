// Lights and button.
#include <utility>

#include "gateway/gateway.hpp"
#include "gateway/team_address.hpp"
#include "host/log.hpp"
#include "panel/address_digits.hpp"

namespace adit::gateway {
namespace {

constexpr std::chrono::seconds kIdentify{10};  // by the button

}  // namespace

std::expected<void, std::string> Gateway::acknowledge(const std::string& id) {
  auto done = overview_.acknowledge(id);
  show_lights();
  return done;
}

void Gateway::show_lights() {
  overview_.show_on(lights_);
  if (std::exchange(told_lights_, lights_.shown()) != lights_.shown()) api_.changed();
}

api::Time Gateway::identify(double seconds) {
  const auto length = std::chrono::duration_cast<loop::Duration>(std::chrono::duration<double>(seconds));
  lights_.set_for(panel::State::Identify, length);
  api_.changed();
  return loop_.wall_now() + seconds;
}

void Gateway::pressed(panel::Press press) {
  accounts_.button_pressed();
  switch (press) {
    case panel::Press::Identify:
      host::log(host::Level::Notice, "the button was pressed");
      identify(std::chrono::duration<double>(kIdentify).count());
      return;
    case panel::Press::ShowAddress: {
      const std::string address = team_address(settings_.team);
      accounts_.open_set_up();
      host::log(host::Level::Notice, "the lights show the address", {{"address", address}});
      if (!address.empty()) lights_.play_digits(panel::address_digits(address));
      show_lights();
      return;
    }
    case panel::Press::Reset:
      host::log(host::Level::Warning, "button held: factory reset");
      if (const auto done = setup_.reset(); !done) {
        host::log(host::Level::Error, "the factory reset failed; hold the button again",
                  {{"why", done.error().sentence}});
      }
  }
}

}  // namespace adit::gateway
