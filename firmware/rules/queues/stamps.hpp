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
#include "queues/overtaken.hpp"

namespace adit::queues {

/// Whether the client set a time stamp. In ROS, 0 means none.
inline bool is_set(const std::optional<icd::Stamp>& stamp) {
  return stamp && *stamp != 0;
}

/// Identifies a clock: the stamps that a client posts to one URI about one robot. URIs are kept apart because
/// maps arrive late by the time of their upload.
struct Stamper {
  std::string address;
  icd::Uri uri = icd::Uri::StateUpdate;
  std::string robot = {};  // "": several robots or none, as for markers
  friend auto operator<=>(const Stamper&, const Stamper&) = default;
};

/// Converts a sender's stamps to the gateway's clock: `theirs + t` becomes `ours + t`.
struct SenderClock {
  icd::Stamp theirs = 0, ours = 0;  // one moment on both clocks
  icd::Stamp latest = 0;            // the latest stamp, on the sender's clock

  icd::Stamp latest_given() const { return ours + (latest - theirs); }
};

/// Converts each sender's time stamps to the gateway's clock and keeps their spacing (ICD 6.2, promise 5).
///
/// - A sender's first stamp becomes now. Its offset is kept from then on: two messages that it stamped 0.3 s
///   apart stay 0.3 s apart, however late they arrive.
/// - If a sender's clock steps, its offset is set again: the stamp becomes now, or the sender's latest
///   converted stamp if that is later. So no stamp goes back. A step is a stamp more than kJump after now, or
///   more than kOldest before the latest one.
/// - Stamps that are less old may be a backlog, posted after newer messages: their stamps jump, or advance
///   faster than time. The clock was set back only if they advance by kSteady as time does, and none of the
///   sender's is as late as its latest one meanwhile. Before that they are converted as before the step.
/// - A message whose upload began before a step is converted as before it, if its stamp fits only so.
/// - A message without a stamp gets its stamp in the same way.
/// - An address has at most kMostOfAddress clocks; further robots share one clock for each URI. Beyond
///   kMostAddresses, the address that was silent longest is dropped.
///
/// The cost of a stamp does not depend on the number of clocks.
class StampShift {
 public:
  static constexpr double kJump = 5.0, kSteady = 5.0, kOldest = 3600.0;  // seconds
  static constexpr double kJitter = 1.0;  // seconds by which a message may arrive later than the one before
  static constexpr std::size_t kMostOfAddress = 64, kMostAddresses = 64;

  /// The converted stamp. `now`: the gateway's clock, seconds since 1970.
  icd::Stamp shift(const Stamper& stamper, std::optional<icd::Stamp> stamp, double now,
                   const Upload& upload = {});
  /// Converts the stamps of the markers of one message, which may be in any order.
  void shift_each(const Stamper& stamper, std::span<icd::Marker> markers, double now,
                  const Upload& upload = {});

  using Clocks = std::vector<std::pair<Stamper, SenderClock>>;
  /// The clocks to record since the last call, with their present values: those whose offset was set, and
  /// those of maps and markers that had a stamp. Record a state's stamps with its poses, for given().
  Clocks changed();
  /// All clocks; the address that was silent longest comes first.
  Clocks clocks() const;
  /// The time that a sender's clock shows now, seconds since 1970. Considers senders that posted within
  /// kSpeaks, and whose clock has run at the gateway's rate for as long. Of several, the earliest in [from,
  /// until), because a clock outside is not set. Nothing if there is none.
  static constexpr double kSpeaks = 10;  // seconds
  std::optional<double> told(double now, double from, double until) const;
  /// Adds a clock of an earlier process, as clocks() or changed() returned it.
  void carry_on(const Stamper& stamper, const SenderClock& clock);
  /// `stamp`: what an earlier process converted for the stamper.
  void given(const Stamper& stamper, icd::Stamp stamp);

 private:
  /// An older stamp, and when it arrived.
  struct Older {
    icd::Stamp stamp = 0;
    double at = 0;
  };
  struct Clock : SenderClock {
    std::optional<Older> older = {};  // since then, no stamp was the latest, and none went faster than time
    SenderClock before = {};          // the last step; for uploads that had begun
    std::uint64_t stepped = 0;        // Upload::ended of the message that showed it
    bool has_changed = false;
  };
  using Named = std::pair<icd::Uri, std::string>;
  struct Address {
    std::map<Named, Clock> clocks;
    std::uint64_t used = 0;  // the value of uses_ at the last use
  };

  Address& address_of(const std::string& address);
  /// The name of the stamper's own clock, or of the shared one.
  static Named name_in(const Address& address, const Stamper& stamper);
  /// Null if the stamper has no clock yet.
  Clock* find(const Stamper& stamper);
  /// `clock`: the stamper's, or null. Sets it if the first stamp creates the clock.
  icd::Stamp shift(Clock*& clock, const Stamper& stamper, std::optional<icd::Stamp> stamp, double now,
                   const Upload& upload);
  /// Whether the stamp shows that the clock was set back.
  static bool is_set_back(Clock& clock, icd::Stamp stamp, double now);

  std::map<std::string, Address> addresses_;
  std::vector<Stamper> changed_;
  std::uint64_t uses_ = 0;
};

/// Keeps the stamps that are sent to one URI from going back.
class StampOrder {
 public:
  /// `stamp`, or the previous result if that is later.
  icd::Stamp next(icd::Stamp stamp);
  /// `last`: the last stamp of an earlier process.
  void carry_on(icd::Stamp last) { last_ = std::max(last_, last); }

 private:
  icd::Stamp last_ = 0;
};

}  // namespace adit::queues
