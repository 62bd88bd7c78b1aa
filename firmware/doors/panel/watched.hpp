#pragma once

#include <cstdint>

#include "panel/button.hpp"
#include "panel/panel.hpp"

namespace adit::panel {

/// Decides the lights from the messages of an aditd: its own lights while it is well, the fault if it is not,
/// and dark after it ended by itself. It reads no clock: each call gets the time, which never runs backward.
class Watched {
 public:
  /// aditd sends its lights at least once a second. After kSilence without them it hangs.
  static constexpr Milliseconds kSilence{1800};
  /// A start may take this long, from the constructor or from the connection. It is systemd's limit.
  static constexpr std::chrono::minutes kStart{1};

  explicit Watched(Instant now) : since_(now) {}

  /// It connected, sent its lights, announced its end, or lost its connection.
  void came(Instant now);
  void lights(const Lit& lit, Instant now);
  void ends(Instant now);
  void gone(Instant now);

  /// The present lights, and when to ask again at the latest.
  Frame frame(Instant now) const;
  bool is_faulty(Instant now) const { return fault_since(now).has_value(); }

 private:
  enum class Phase : std::uint8_t { Awaited, Well, Ended, Dead };
  void enter(Phase phase, Instant now);
  std::optional<Instant> fault_since(Instant now) const;

  Phase phase_ = Phase::Awaited;
  Instant since_;  // start of the phase; of Well: the last lights
  Lit lit_{};
};

}  // namespace adit::panel
