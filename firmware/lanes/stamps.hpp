#pragma once

#include <cstddef>
#include <cstdint>
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
/// kJump, or to more than kJump after now) starts anew. A message without a stamp (or with
/// 0, ROS's word for none) is stamped now, or with the latest stamp of its sender where that is later. Of
/// more than kMostSenders, the one that was silent longest is forgotten.
class StampShift {
 public:
  static constexpr double kJump = 5.0;  // seconds
  static constexpr std::size_t kMostSenders = 1024;

  /// `now`: the gateway's clock, seconds since 1970. `sender`: any key that stands for one clock.
  icd::Stamp shift(const std::string& sender, std::optional<icd::Stamp> stamp, double now);

 private:
  struct Clock {
    icd::Stamp theirs = 0, ours = 0;  // one moment, by both clocks
    icd::Stamp latest = 0;            // the sender's own
    std::uint64_t used = 0;           // the higher, the later
  };
  icd::Stamp latest_of(const std::string& sender) const;
  void forget_the_most_silent();

  std::map<std::string, Clock> senders_;
  std::uint64_t uses_ = 0;
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
