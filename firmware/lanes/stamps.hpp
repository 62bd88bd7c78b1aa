#pragma once

#include <map>
#include <optional>
#include <string>

#include "icd/header.hpp"

namespace adit::lanes {

/// ICD 6.2 and promise 5: brings each sender's stamps to the gateway's clock, keeping the spacing it gave
/// them.
///
/// A sender's first stamp is taken as now; from then on its offset is kept, so that two messages it stamped
/// 0.3 s apart stay 0.3 s apart however late they came. A sender whose clock jumped (backward by more than
/// kJump, or to more than kJump after now) starts anew. A message without a stamp is stamped now.
class StampShift {
 public:
  static constexpr double kJump = 5.0;  // seconds

  /// `now`: the gateway's clock, seconds since 1970. `sender`: any key that stands for one clock.
  icd::Stamp shift(const std::string& sender, std::optional<icd::Stamp> stamp, double now);

 private:
  struct Clock {
    double offset = 0;    // gateway - sender
    icd::Stamp last = 0;  // the sender's own
  };
  std::map<std::string, Clock> senders_;
};

/// The stamps that go upstream for one URI: never backward.
class StampOrder {
 public:
  /// `stamp`, or the last one given out where that is later.
  icd::Stamp next(icd::Stamp stamp);

 private:
  icd::Stamp last_ = 0;
};

}  // namespace adit::lanes
