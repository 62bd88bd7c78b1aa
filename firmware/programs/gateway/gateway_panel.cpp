// Lights and button.
#include <algorithm>

#include "gateway/gateway.hpp"
#include "host/interfaces.hpp"
#include "host/log.hpp"
#include "panel/address_digits.hpp"
#include "settings/subnet.hpp"

namespace adit::gateway {
namespace {

using panel::State;

constexpr std::chrono::seconds kIdentify{10};  // by the button

}  // namespace

void Gateway::assert_states() {
  const bool serving = listeners_.serves() && flow_.scoring().trouble().empty();
  lights_.set(State::Serving, serving);
  lights_.set(State::NotServing, !serving);
  const auto posts = overview_.endpoints();
  lights_.set(State::ScoringConnected, posts[0].connected);
  lights_.set(State::ScoringFailing, !posts[0].trouble.empty());
  lights_.set(State::ReportWaiting, !flow_.reports().waiting_here().empty());
  lights_.set(State::MappingConnected, posts[1].connected);
  lights_.set(State::MappingFailing, !posts[1].trouble.empty());
  const auto all = overview_.alarms();
  const auto calling = std::ranges::count_if(all, alarms::calls);
  const auto seen = std::ranges::count_if(
      all, [](const alarms::Alarm& alarm) { return alarms::calls(alarm) && alarm.acknowledged; });
  lights_.set(State::NeedsOperator, calling > seen);
  lights_.set(State::Acknowledged, calling > 0);
  lights_.set(State::UpdateRunning, updates_.running());
  for (const api::LinkRow& link : links_.rows()) {
    lights_.set(link.side == "team" ? State::TeamUnplugged : State::CommandPostUnplugged,
                !link.carrier.value_or(false));
  }
  if (lights_.has(State::SetUpOpen) && !accounts_.set_up_open()) {
    host::log(host::Level::Notice, "set-up is closed");
  }
  lights_.set(State::SetUpOpen, accounts_.set_up_open());
}

std::expected<void, std::string> Gateway::acknowledge(const std::string& id) {
  auto done = overview_.acknowledge(id);
  show_lights();
  return done;
}

void Gateway::show_lights() {
  assert_states();
  if (std::exchange(told_lights_, lights_.shown()) != lights_.shown()) api_.changed();
}

api::Time Gateway::identify(double seconds) {
  const auto length = std::chrono::duration_cast<loop::Duration>(std::chrono::duration<double>(seconds));
  lights_.set_for(State::Identify, length);
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
    case panel::Press::ShowAddress:
      accounts_.open_set_up();
      show_address();
      show_lights();
      return;
    case panel::Press::Reset:
      host::log(host::Level::Warning, "button held: factory reset");
      if (const auto done = setup_.reset(); !done) {
        host::log(host::Level::Error, "the factory reset failed; hold the button again",
                  {{"why", done.error().sentence}});
      }
  }
}

void Gateway::show_address() {
  const std::string address = team_address();
  host::log(host::Level::Notice, "the lights show the address", {{"address", address}});
  if (!address.empty()) lights_.play_digits(panel::address_digits(address));
}

/// The box's IPv4 address for the team, or "".
std::string Gateway::team_address() const {
  const settings::Team& team = settings_.team;
  if (!team.interface.empty()) {
    const auto own = host::own_address(team.interface);
    host::log_failure(host::Level::Warning, "the team's address is unknown", own);
    return own && *own ? settings::ipv4_text((*own)->address) : "";
  }
  const auto given = std::ranges::find_if(team.listen, [](const settings::Address& each) {
    return settings::ipv4_of(each.address).value_or(0) != 0;
  });
  return given == team.listen.end() ? "" : given->address;
}

}  // namespace adit::gateway
