#pragma once

#include <chrono>
#include <optional>

#include "loop/loop.hpp"

namespace adit::forward {

/// A flow's end: waits for requests in flight and for storing, each for a limited time, then dismisses
/// clients and lets their answers leave.
class Ending {
 public:
  static constexpr std::chrono::milliseconds kAnswers{800};      // for requests in flight
  static constexpr std::chrono::milliseconds kKeepWithin{3000};  // for messages that are being stored
  static constexpr std::chrono::milliseconds kStep{10};
  static constexpr std::chrono::milliseconds kFlush{50};  // for the last answers

  void begin(loop::Instant now) { began_ = now; }
  bool has_begun() const { return began_.has_value(); }
  /// True if clients are to be dismissed now. `quiet`: no request in flight; `kept`: all is stored. Requires
  /// has_begun().
  bool dismisses(loop::Instant now, bool quiet, bool kept);
  /// True after the dismissal, or if storing fails for too long. Requires has_begun().
  bool is_over(loop::Instant now) const;

 private:
  std::optional<loop::Instant> began_;
  bool dismissed_ = false;  // only answers are still to leave
};

}  // namespace adit::forward
