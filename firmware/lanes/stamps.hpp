#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "icd/header.hpp"
#include "icd/markers_update.hpp"
#include "icd/uri.hpp"
#include "lanes/step_back.hpp"

namespace adit::lanes {

/// Whether the client stamped the message: 0 is ROS's "none".
inline bool is_set(const std::optional<icd::Stamp>& stamp) {
  return stamp && *stamp != 0;
}

/// Whose stamps one clock makes: what a client posts to one URI about one robot. Maps come late by their
/// upload, so their stamps say nothing of a state's.
struct Stamper {
  std::string address;
  icd::Uri uri = icd::Uri::StateUpdate;
  std::string robot = {};  // "": of several or none, as markers are
  friend auto operator<=>(const Stamper&, const Stamper&) = default;
};

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
/// newer than all before. A message without a stamp is stamped in the same way.
///
/// An address has at most kMostOfAddress clocks: once it has them, all robots that are new share one for each
/// URI. Of more than kMostAddresses, the one that was silent longest is forgotten. A stamp costs the same
/// however many clocks there are.
class StampShift {
 public:
  static constexpr double kJump = 5.0;  // seconds
  static constexpr std::size_t kMostOfAddress = 64, kMostAddresses = 64;

  /// `now`: the gateway's clock, seconds since 1970. `connection`: what the message came on.
  icd::Stamp shift(const Stamper& stamper, std::optional<icd::Stamp> stamp, double now,
                   Connection connection = 0);
  /// The markers of one message have stamps of their own, which are in no order.
  void shift_each(const Stamper& stamper, std::span<icd::Marker> markers, double now);

  using Clocks = std::vector<std::pair<Stamper, SenderClock>>;
  /// Those that have told a stamp since this was asked last, each as it is now.
  Clocks changed();
  /// All of them, the address that was silent longest first.
  Clocks clocks() const;
  /// What the sender's clock shows now that spoke within kSpeaks, and for as long by a clock that runs as the
  /// gateway's does; of several, the earliest that is not before `from` and is before `until`: others are not
  /// set.
  static constexpr double kSpeaks = 10;  // seconds
  std::optional<double> told(double now, double from, double until) const;
  /// A clock of an earlier life goes on.
  void carry_on(const Stamper& stamper, const SenderClock& clock);

 private:
  struct Clock : SenderClock {
    StepBack step_back = {};
    bool has_changed = false;
  };
  using Named = std::pair<icd::Uri, std::string>;
  struct Address {
    std::map<Named, Clock> clocks;
    std::uint64_t used = 0;  // the higher, the later
  };

  Address& address_of(const std::string& address);
  /// By its own name, or by the one that it shares.
  static Named name_in(const Address& address, const Stamper& stamper);
  /// Null: it has told no stamp yet.
  Clock* find(const Stamper& stamper);
  /// `clock`: the stamper's, or null; afterwards the one that its first stamp has begun.
  icd::Stamp shift(Clock*& clock, const Stamper& stamper, std::optional<icd::Stamp> stamp, double now,
                   Connection connection);

  std::map<std::string, Address> addresses_;
  std::vector<Stamper> changed_;
  std::uint64_t uses_ = 0;
};

/// The stamps that go upstream for one URI: never backward.
class StampOrder {
 public:
  /// `stamp`, or the last one given out if that is later.
  icd::Stamp next(icd::Stamp stamp);
  /// `last` was the last of an earlier life.
  void carry_on(icd::Stamp last) { last_ = std::max(last_, last); }

 private:
  icd::Stamp last_ = 0;
};

}  // namespace adit::lanes
