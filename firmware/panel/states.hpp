#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "panel/panel.hpp"

namespace adit::panel {

/// What the panel can tell. States are asserted and cleared one by one; which of those that are asserted a
/// light shows is decided by their priorities alone.
enum class State : std::uint8_t {
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

/// A row of the one table of states, which README.md has too.
struct StateRow {
  State state;
  std::string_view name;                                        // "reset warning"
  int priority;                                                 // of two on one light the higher shows
  std::array<std::optional<Pattern>, kLights.size()> patterns;  // by Light; nothing: leaves it to others
  std::string_view meaning;
};
/// In the order of State, which is that of their priorities, the highest first.
std::span<const StateRow> state_table();
inline constexpr std::size_t kStates = static_cast<std::size_t>(State::MappingConnected) + 1;

/// The states that are asserted. At first none is, and all lights are dark.
class States {
 public:
  /// True: it was not so before.
  bool set(State state, bool asserted);
  bool has(State state) const { return asserted_[static_cast<std::size_t>(state)]; }
  /// For each light the pattern of the state with the highest priority that says anything of it; dark where
  /// none does.
  Lights shown() const;

 private:
  std::array<bool, kStates> asserted_{};
};

}  // namespace adit::panel
