#pragma once

#include <cstdint>

#include "panel/button.hpp"
#include "panel/panel.hpp"

namespace adit::panel {

/// What the lights show of an aditd that is watched: what it tells while it is well, the fault while it is
/// not, and nothing where it ended by itself. It knows no clock: each call says what time it is, and times
/// never run backward.
class Watched {
 public:
  /// It tells at least so often that it is well; and has hung where it has told nothing for so long.
  static constexpr Milliseconds kBeat{400}, kSilence{1500};
  /// So long a start may take, from whoever waits for it or from the connection on: systemd waits no longer.
  static constexpr std::chrono::minutes kStart{1};

  explicit Watched(Instant now) : since_(now) {}

  /// It connected, told what is to be lit, said that it ends, or its connection ended.
  void came(Instant now);
  void lights(const Lit& lit, Instant now);
  void ends(Instant now);
  void gone(Instant now);

  /// What is to be lit by now, and when to ask again at the latest.
  Frame frame(Instant now) const;
  bool is_faulty(Instant now) const { return fault_since(now).has_value(); }

 private:
  enum class Phase : std::uint8_t { Awaited, Well, Ended, Dead };
  void enter(Phase phase, Instant now);
  std::optional<Instant> fault_since(Instant now) const;

  Phase phase_ = Phase::Awaited;
  Instant since_;  // when the phase began; where it is well, when that was told last
  Lit lit_{};
};

}  // namespace adit::panel
