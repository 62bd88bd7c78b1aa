#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "icd/grid_bounds.hpp"
#include "icd/mapping.hpp"
#include "icd/uri.hpp"
#include "queues/lattice.hpp"
#include "queues/queued_map.hpp"

namespace adit::queues {

/// The upload of a client's message. One message overtakes another one of the same client about the same
/// thing if it has a newer stamp and was accepted after the other one's upload had begun. Otherwise the
/// message whose upload began later is the newer one, whatever its stamp.
struct Upload {
  std::string address = {};
  std::size_t bytes = 0;  // of the body as received
  /// Places in the order in which uploads began and ended, from 1; 0: unknown.
  std::uint64_t began = 0, ended = 0;
  /// The first beginning of the client's other uploads that are not over; 0: there are none.
  std::uint64_t overlaps = 0;
};

/// The accepted maps that may overtake others, because their clients have other uploads that are not over.
class OvertakenMaps {
 public:
  static constexpr std::size_t kMostClients = 64, kMostOfClient = 256;

  /// The bounds of the accepted maps that overtook `map`. Of clouds they are empty.
  std::vector<icd::GridBounds> find_newer(const icd::MapUpdate& map, const Upload& upload) const;

  /// Whether a map is being stored that may have overtaken this upload, so that find_newer() is not known
  /// yet, or one that was overtaken itself and must be queued first.
  bool must_wait(const Upload& upload) const;
  /// A map is being stored; until end().
  void begin(const Upload& upload, bool is_overtaken) { stored_.push_back({upload, is_overtaken}); }
  void end(const Upload& upload);
  /// `map`, with a stamp, was accepted. Of an overtaken grid, call it for each queued part: others are older.
  void record(const icd::MapUpdate& map, const Upload& upload);
  bool empty() const { return stored_.empty(); }

 private:
  struct AcceptedMap {
    Sender sender;
    icd::Stamp stamp = 0;
    std::uint64_t ended = 0;
    icd::GridBounds bounds = {};
  };
  struct StoredMap {
    Upload upload;
    bool is_overtaken = false;
  };

  std::map<std::string, std::vector<AcceptedMap>> clients_;  // by address
  std::vector<StoredMap> stored_;                            // now
};

/// Rectangles of the cells of `older` that no newer grid covers. A cell is covered if its middle is
/// (icd::covered_part()). All cells of a grid that is too far away for corner_at().
std::vector<Cells> cells_outside(const icd::OccupancyGrid& older, std::span<const icd::GridBounds> newer);

/// The accepted changes of markers that may overtake others.
class OvertakenMarkers {
 public:
  static constexpr std::size_t kMostBytes = 1u << 20;  // as in icd::bytes_of(); beyond it, none are kept

  /// Removes changes that newer ones of the same ns and id, or a newer DeleteAll, overtook; returns their
  /// number. Behind an overtaken DeleteAll, adds those that no other client has replaced.
  std::size_t remove_from(icd::MarkersUpdate& update, const Upload& upload) const;
  /// `update`, which has stamps, was accepted.
  void record(const icd::MarkersUpdate& update, const Upload& upload);

 private:
  struct Change {
    icd::Marker marker;
    std::uint64_t ended = 0;
    bool stands = true;  // no later change of another client replaced it
  };
  struct Client {
    std::map<std::pair<std::string, std::int32_t>, Change> changes;  // by ns and id, after delete_all
    Change delete_all;
  };
  void replace_others(const icd::Marker& newer, const std::string& address);
  void forget(const std::string& address);

  std::map<std::string, Client> clients_;  // by address
  std::size_t bytes_ = 0;
};

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
/// - A sender's first stamp becomes now. Its offset is kept from then on: two messages that it stamped 0.3 s
///   apart stay 0.3 s apart, however late they arrive.
/// - If a sender's clock steps, its offset is set again: the stamp becomes now, or the sender's latest
///   converted stamp if that is later. So no stamp goes back. A step is a stamp more than kJump after now, or
///   more than kOldest before the latest one.
/// - Stamps that are less old may be a backlog, posted after newer messages: their stamps jump, or advance
///   faster than time. The clock was set back only if they advance by kSteady as time does, and none of the
///   sender's is as late as its latest one meanwhile. Before that they are converted as before the step. An
///   upload shows no time if it began before that of the first one ended.
/// - A message whose upload began before a step is converted as before it, if its stamp fits only so. So is
///   one whose clock was set back and that was stamped before the message that showed it.
/// - A message without a stamp gets its stamp in the same way.
/// - An address has at most kMostOfAddress clocks; further robots share one clock for each URI. Beyond
///   kMostAddresses, the address that was silent longest is dropped.
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
  /// those of maps and markers that had a stamp. Record a state's stamps with its poses, for restore_stamp().
  Clocks take_changed();
  /// All clocks; the address that was silent longest comes first.
  Clocks clocks() const;
  /// The time that a sender's clock shows now, seconds since 1970. Considers senders that posted within
  /// kSpeaks, and whose clock has run at the gateway's rate for as long. Of several, the earliest in [from,
  /// until), because a clock outside is not set. Nothing if there is none.
  static constexpr double kSpeaks = 10;  // seconds
  std::optional<double> sender_time(double now, double from, double until) const;
  /// Adds a clock of an earlier process, as clocks() or take_changed() returned it.
  void restore(const Stamper& stamper, const SenderClock& clock);
  /// `stamp`: what an earlier process converted for the stamper.
  void restore_stamp(const Stamper& stamper, icd::Stamp stamp);

 private:
  /// An older stamp, and when it arrived.
  struct OlderStamp {
    icd::Stamp stamp = 0;
    double at = 0;
    std::uint64_t ended = 0;  // Upload::ended
  };
  struct Clock : SenderClock {
    std::optional<OlderStamp> older =
        {};                     // since then, no stamp was the latest, and none went faster than time
    SenderClock before = {};    // the last step; for uploads that had begun
    std::uint64_t stepped = 0;  // Upload::ended of the message that showed it
    bool has_changed = false;
  };
  using ClockKey = std::pair<icd::Uri, std::string>;
  struct Address {
    std::map<ClockKey, Clock> clocks;
    std::uint64_t used = 0;  // the value of uses_ at the last use
  };

  Address& address_of(const std::string& address);
  /// The name of the stamper's own clock, or of the shared one.
  static ClockKey name_in(const Address& address, const Stamper& stamper);
  /// Null if the stamper has no clock yet.
  Clock* find(const Stamper& stamper);
  /// `clock`: the stamper's, or null. Sets it if the first stamp creates the clock.
  icd::Stamp shift(Clock*& clock, const Stamper& stamper, std::optional<icd::Stamp> stamp, double now,
                   const Upload& upload);
  /// Whether the stamp shows that the clock was set back.
  static bool is_set_back(Clock& clock, icd::Stamp stamp, double now, const Upload& upload);

  std::map<std::string, Address> addresses_;
  std::vector<Stamper> changed_;
  std::uint64_t uses_ = 0;
};

}  // namespace adit::queues
