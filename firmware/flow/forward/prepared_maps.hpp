#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "forward/map_store.hpp"
#include "forward/stitched.hpp"
#include "forward/traffic_counts.hpp"
#include "forward/uri_pace.hpp"
#include "loop/loop.hpp"
#include "loop/watchdog.hpp"
#include "pack/pack.hpp"
#include "queues/clouds.hpp"
#include "queues/map_queue.hpp"
#include "settings/settings.hpp"
#include "uplink/connection.hpp"

namespace adit::forward {

/// What one map after the other may hold, by what the last ones showed: how fast the link takes bytes, and
/// how small packing makes clouds.
class Slot {
 public:
  static constexpr std::chrono::milliseconds kLongestLead{1500};

  /// `most`: bytes a second that maps may use of the link.
  explicit Slot(std::uint64_t most) { allow(most); }
  void allow(std::uint64_t most);

  /// A map was packed, which took so long.
  void packing_took(loop::Duration took);
  /// Effort::Full packs so many bytes of a cloud's points to so many, at that precision.
  void packed(std::size_t points, std::size_t bytes, queues::Precision precision);
  /// A worker took so long to pack a map for which pack::seconds_for() expects so many seconds; 0: the map
  /// was not compressed.
  void worker_took(loop::Duration took, double expected);
  /// So many bytes left, of which the last were held back until then.
  void left(std::size_t bytes, const uplink::Sent& sent, loop::Instant last_byte_not_before);

  /// The link takes no more than so many bytes a second now; 0: not known.
  void link_delivers(std::uint64_t bytes_per_second);

  /// The endpoint accepted a message of so many bytes, or answered that it is too large.
  void on_passed(std::size_t bytes);
  void on_too_large(std::size_t bytes);
  /// Another endpoint may accept other sizes.
  void forget_sizes() { largest_ = 0, limit_ = kNoLimit; }
  /// After so many accepted messages within the limit, a larger one is tried.
  static constexpr int kTryLarger = 60;
  /// The bytes of a message that the endpoint accepts, as far as its answers show. A part may have a little
  /// more than its share (fits()).
  std::size_t limit() const { return smaller_ < kTryLarger ? limit_ : kNoLimit; }

  bool fits(std::size_t bytes) const { return bytes - bytes / 32 <= limit(); }

  /// How long before its time the next map is to be packed: as the longest of the last few took, for where
  /// one comes too late, the link is idle; at most kLongestLead, for until then newer data takes its place.
  loop::Duration lead() const;
  /// How long so many bytes take to leave.
  loop::Duration transfer(std::size_t bytes) const;
  /// The conditions that decide the effort for a map, if maps are `spacing` apart. Until a map has shown how
  /// fast the link is, it is as fast as allow() says.
  pack::Hurry hurry(loop::Duration spacing) const;
  /// How many bytes of points, not packed, leave within `spacing` and within limit(), at each precision: by
  /// the last cloud, and by what rounding makes of clouds.
  queues::PointsAt points_within(loop::Duration spacing) const;

 private:
  loop::Duration packing_takes_{0};
  double most_ = 1, bytes_per_second_ = 1;
  double packed_to_ = 1;  // of a byte of a cloud that is exact
  double slowness_ = 1;   // pack::Hurry's
  static constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();
  std::size_t largest_ = 0;  // that the endpoint accepted
  std::size_t limit_ = kNoLimit;
  int smaller_ = 0;  // messages accepted since the last one that was too large
};

/// A map that was taken from the queue.
struct PreparedMap {
  queues::QueuedMap waiting;
  Packed packed{};                           // empty body: not packed, or nothing to send
  std::vector<MapStore::Damaged> damaged{};  // cannot be sent
  loop::Duration packing_took{0};            // by the worker
  bool is_under_way = false, went_ahead = false;
  bool begins_again = false;  // a piece, in flight when the Command Post may have lost those before it
  loop::Instant last_byte_not_before{};
  std::optional<loop::Instant> arrived{};  // estimate
};

/// The map that is next or in flight, and the one that follows it. A worker packs one of them at a time.
class PreparedMaps {
 public:
  using Place = std::shared_ptr<PreparedMap>;

  /// `packed`: called after the work, with false if it failed. All outlive this.
  PreparedMaps(loop::Loop& loop, loop::Workers& workers, const settings::Settings& settings,
               TrafficCounts& counts, UriPace& pace, queues::MapQueue& queue, MapStore& store,
               std::function<void(bool is_done)> packed);

  const Place& first() const { return first_; }
  const Place& following() const { return following_; }
  std::vector<const PreparedMap*> of(const Traffic& traffic) const;
  /// If one of them contains `back`, which was not delivered, it stands for `back` from now on.
  std::optional<queues::Replaced> absorb(const queues::QueuedMap& back);

  /// Takes the next map from the queue, and packs it. `delivers`: the link's bytes per second, or 0.
  void prepare(bool follows, std::uint64_t delivers);
  void pack(const Place& prepared);
  bool is_packing() const { return is_packing_; }

  /// Removes a map that is not retried. The following one may be in flight already.
  void leaves(const Place& sent);
  /// A failed map returns to the queue, after newer ones: old cells never follow newer ones.
  void again(const Place& sent);
  /// Returns the following map to the queue, except one in flight.
  void put_back_following() { put_back(following_); }
  /// The Command Post may have another map. Returns both, because they may cover old cells, and maps in
  /// pieces begin again, also one in flight.
  void pack_again();

  Slot& slot() { return slot_; }
  const Slot& slot() const { return slot_; }

 private:
  Place* place_of(const Place& prepared);
  void put_back(Place& prepared);
  void work_done(const Place& prepared);
  void work_failed(const Place& prepared);
  void is_damaged(Place& place);
  void skip_piece(Place& place);

  loop::Loop& loop_;
  loop::Workers& workers_;
  const settings::Settings& settings_;
  TrafficCounts& counts_;
  UriPace& pace_;
  queues::MapQueue& queue_;
  MapStore& store_;
  std::function<void(bool is_done)> packed_;
  Slot slot_;
  Place first_, following_;
  bool is_packing_ = false;
  loop::JobWatch packing_;
};

}  // namespace adit::forward
