#include "panel/states.hpp"

namespace adit::panel {
namespace {

using namespace std::chrono_literals;

constexpr Milliseconds kDigitFlash = 200ms, kBetween = 300ms, kAfter = 1200ms;  // after a digit or a dot
constexpr Milliseconds kLong = 1000ms, kBefore = 1500ms;                        // before each time

void add_flashes(std::vector<Step>& steps, int count, Milliseconds length) {
  for (int i = 0; i < count; ++i) {
    steps.push_back({true, length});
    steps.push_back({false, i + 1 == count ? kAfter : kBetween});
  }
}

}  // namespace

std::vector<Step> address_digits(std::string_view address) {
  std::vector<Step> steps;
  for (int time = 0; time < 2; ++time) {
    steps.push_back({false, kBefore});
    for (const char c : address) {
      if (c == '.') add_flashes(steps, 1, kLong);
      if (c >= '0' && c <= '9') add_flashes(steps, c == '0' ? 10 : c - '0', kDigitFlash);
    }
  }
  return steps;
}

namespace {

constexpr std::optional<Pattern> kLeft;  // leaves the light to later states
constexpr auto kOff = Pattern::Off, kOn = Pattern::On, kSlow = Pattern::Slow, kFast = Pattern::Fast,
               kTwice = Pattern::Twice, kFlash = Pattern::Flash, kWink = Pattern::Wink, kRush = Pattern::Rush,
               kDigits = Pattern::Digits;

// The first asserted state is shown. The last action at the box comes first, then worse before better. Open
// set-up precedes an operator's pending action, because its remaining time is shown only here.
constexpr StateRow kTable[] = {
    {LightState::Fault,
     "fault",
     {kSlow, kOff, kOff, kOff},
     "Adit has died or hangs, and restarts; if this lasts, power off and on"},
    {LightState::ResetWarning,
     "reset warning",
     {kRush, kRush, kRush, kRush},
     "button held: release it, or a factory reset follows"},
    {LightState::ButtonHeld,
     "button held",
     {kOn, kOn, kOn, kOn},
     "button held: release it for the address and set-up"},
    {LightState::Identify, "identify", {kTwice, kTwice, kTwice, kTwice}, "identifies this box"},
    {LightState::Address,
     "address",
     {kOff, kOff, kOff, kDigits},
     "shows the box's address on the team's side"},
    {LightState::UpdateRunning,
     "update running",
     {kWink, kLeft, kLeft, kLeft},
     "installs an update: leave the power on"},
    {LightState::CommandPostUnplugged,
     "Command Post unplugged",
     {kLeft, kFlash, kFlash, kLeft},
     "no link to the Command Post: is the cable in?"},
    {LightState::TeamUnplugged,
     "team unplugged",
     {kFlash, kLeft, kLeft, kLeft},
     "no link to the team: is the cable in?"},
    {LightState::NotServing,
     "not serving",
     {kFast, kLeft, kLeft, kLeft},
     "Adit does not listen on the team's side, or cannot store reports: see the page"},
    {LightState::ScoringFailing,
     "scoring failing",
     {kLeft, kFast, kLeft, kLeft},
     "the last request failed, was rejected or unanswered"},
    {LightState::MappingFailing,
     "mapping failing",
     {kLeft, kLeft, kFast, kLeft},
     "the last update failed, was rejected or unanswered"},
    {LightState::SetUpOpen,
     "set-up open",
     {kLeft, kLeft, kLeft, kSlow},
     "for ten minutes, a new password needs no old one"},
    {LightState::NeedsOperator,
     "needs operator",
     {kLeft, kLeft, kLeft, kFast},
     "a person must decide: see the page"},
    {LightState::Acknowledged,
     "acknowledged",
     {kLeft, kLeft, kLeft, kOn},
     "an acknowledged alarm is still active"},
    {LightState::ReportWaiting,
     "report waiting",
     {kLeft, kSlow, kLeft, kLeft},
     "a report waits for its answer"},
    {LightState::Serving,
     "serving",
     {kOn, kLeft, kLeft, kLeft},
     "Adit serves the team and can store reports"},
    {LightState::ScoringConnected,
     "scoring connected",
     {kLeft, kOn, kLeft, kLeft},
     "connected to the scoring endpoint, no report waits"},
    {LightState::MappingConnected,
     "mapping connected",
     {kLeft, kLeft, kOn, kLeft},
     "connected to the mapping endpoint"},
};

static_assert(std::size(kTable) == kStates);

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < kStates; ++i) {
    if (static_cast<std::size_t>(kTable[i].state) != i) return false;
  }
  return true;
}
static_assert(is_in_order());

}  // namespace

std::span<const StateRow> state_table() {
  return kTable;
}

bool States::set(LightState state, bool asserted) {
  bool& now = asserted_[static_cast<std::size_t>(state)];
  const bool changed = now != asserted;
  now = asserted;
  return changed;
}

Lights States::current_lights() const {
  Lights lights{};
  for (const Light light : kLights) {
    for (const StateRow& row : kTable) {
      const auto& pattern = row.patterns[index_of(light)];
      if (!has(row.state) || !pattern) continue;
      lights[index_of(light)] = *pattern;
      break;
    }
  }
  return lights;
}

}  // namespace adit::panel
