#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "icd/header.hpp"
#include "lanes/step_back.hpp"

namespace adit::lanes {

/// How a sender's stamps become the gateway's: a stamp so much later than `theirs` is as much later than
/// `ours`.
struct SenderClock {
  icd::Stamp theirs = 0, ours = 0;  // one moment, by both clocks
  icd::Stamp latest = 0;            // the sender's own

  icd::Stamp latest_given() const { return ours + (latest - theirs); }
};

/// ICD 6.2 and promise 5: brings each sender's stamps to the gateway's clock, keeping the spacing it gave
/// them.
///
/// A sender's first stamp counts as now. From then on its offset is kept, so that two messages that it
/// stamped 0.3 s apart stay 0.3 s apart, however late they came. If a sender's clock jumps (back by more than
/// kJump, or by less if StepBack shows it, or to more than kJump after now), its offset is taken again: its
/// stamp counts as now, or as the latest that it was given if that is later, so that what it says next is
/// newer than all before. A message without a stamp (or with 0, which is ROS's "none") is stamped in the same
/// way. Of more than kMostSenders, the one that was silent longest is forgotten.
class StampShift {
 public:
  static constexpr double kJump = 5.0;  // seconds
  static constexpr std::size_t kMostSenders = 1024;

  /// `now`: the gateway's clock, seconds since 1970. `sender`: any key that stands for one clock.
  /// `connection`: what the message came on; 0 where a message has several stamps, which are in no order.
  icd::Stamp shift(const std::string& sender, std::optional<icd::Stamp> stamp, double now,
                   Connection connection = 0);

  /// As shift() left it; null for a sender that is not known.
  const SenderClock* clock_of(const std::string& sender) const;
  /// All of them, the one that was silent longest first.
  std::vector<std::pair<std::string, SenderClock>> clocks() const;
  /// What the sender's clock shows now that spoke within kSpeaks, and for as long by a clock that runs as the
  /// gateway's does; of several, the earliest that is not before `from` and is before `until`: others are not
  /// set.
  static constexpr double kSpeaks = 10;  // seconds
  std::optional<double> told(double now, double from, double until) const;
  /// A clock of an earlier life goes on.
  void carry_on(const std::string& sender, const SenderClock& clock);

 private:
  struct Clock : SenderClock {
    std::uint64_t used = 0;  // the higher, the later
    StepBack step_back;
  };
  icd::Stamp latest_of(const std::string& sender) const;
  void forget_the_most_silent();

  std::map<std::string, Clock> senders_;
  std::uint64_t uses_ = 0;
};

/// The stamps that go upstream for one URI: never backward.
class StampOrder {
 public:
  /// `stamp`, or the last one given out if that is later.
  icd::Stamp next(icd::Stamp stamp);
  /// The last one given out; 0: none.
  icd::Stamp last() const { return last_; }
  /// `last` was the last of an earlier life.
  void carry_on(icd::Stamp last) { last_ = std::max(last_, last); }

 private:
  icd::Stamp last_ = 0;
};

}  // namespace adit::lanes
