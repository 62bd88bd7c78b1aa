#pragma once

#include <chrono>
#include <optional>

#include "loop/loop.hpp"

namespace adit::forward {

/// How a flow ends: it waits for requests under way and for messages being kept, for each only a bounded
/// time; then the clients that still wait are dismissed, and their answers leave.
class Ending {
 public:
  static constexpr std::chrono::milliseconds kAnswers{800};      // so long it waits for answers under way
  static constexpr std::chrono::milliseconds kKeepWithin{3000};  // and so long for what is being kept
  static constexpr std::chrono::milliseconds kStep{10};
  static constexpr std::chrono::milliseconds kFlush{50};  // in which the answers just given leave

  void begin(loop::Instant now) { began_ = now; }
  bool has_begun() const { return began_.has_value(); }
  /// Whether the clients are dismissed by now. `quiet`: nothing is under way; `kept`: nothing is being kept.
  /// Requires has_begun().
  bool dismisses(loop::Instant now, bool quiet, bool kept);
  /// They were dismissed, or something fails again and again. Requires has_begun().
  bool is_over(loop::Instant now) const;

 private:
  std::optional<loop::Instant> began_;
  bool dismissed_ = false;  // all clients have been told; only their answers have to leave
};

}  // namespace adit::forward
