#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "panel/panel.hpp"

namespace adit::panel {

/// An IPv4 address as flashes to count. A digit is that many flashes (ten for 0), a dot one long flash. A
/// pause follows each. The address is shown twice, with a longer pause between. `address` is in text form;
/// characters other than digits and dots are skipped.
std::vector<Step> address_digits(std::string_view address);

/// The panel's states. Each is asserted and cleared by itself. If several states concern a light, it shows
/// the first of them here.
enum class LightState : std::uint8_t {
  Fault,
  ResetWarning,
  ButtonHeld,
  Identify,
  Address,
  UpdateRunning,
  CommandPostUnplugged,
  TeamUnplugged,
  NotServing,
  ScoringFailing,
  MappingFailing,
  SetUpOpen,
  NeedsOperator,
  Acknowledged,
  ReportWaiting,
  Serving,
  ScoringConnected,
  MappingConnected,
};

/// A row of the table of states, which is also on board/card.html.
struct StateRow {
  LightState state;
  std::string_view name;                                        // "reset warning"
  std::array<std::optional<Pattern>, kLights.size()> patterns;  // by Light; nullopt: does not concern it
  std::string_view meaning;
};
/// In the order of LightState.
std::span<const StateRow> state_table();
inline constexpr std::size_t kStates = static_cast<std::size_t>(LightState::MappingConnected) + 1;

/// The asserted states. At first there are none, and all lights are dark.
class States {
 public:
  /// True if this changed the state.
  bool set(LightState state, bool asserted);
  bool has(LightState state) const { return asserted_[static_cast<std::size_t>(state)]; }
  /// For each light, the pattern of the first asserted state that concerns it, or dark.
  Lights current_lights() const;

 private:
  std::array<bool, kStates> asserted_{};
};

}  // namespace adit::panel
