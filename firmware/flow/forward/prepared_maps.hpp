#pragma once

#include <optional>

#include "forward/map_store.hpp"
#include "forward/slot.hpp"
#include "forward/stitched.hpp"
#include "forward/traffic_counts.hpp"
#include "forward/uri_pace.hpp"
#include "loop/watchdog.hpp"
#include "queues/map_queue.hpp"
#include "settings/settings.hpp"

namespace adit::forward {

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
  /// False: pack the map, because it is not packed, or points that it leaves out were forgotten.
  bool is_packed(PreparedMap& prepared) const;

  /// Removes a map that is not retried. The following one may be in flight already.
  void leaves(const Place& sent);
  /// A failed map returns to the queue, after newer ones: old cells never follow newer ones.
  void again(const Place& sent);
  /// Returns the following map to the queue, except one in flight.
  void put_back_following() { put_back(following_); }
  /// The Command Post may have another map. Returns both, because they may cover old cells, and maps in
  /// pieces begin again, also one in flight.
  void pack_again();
  /// Keeps only the points of a delivered cloud that were sent.
  void points_taken(PreparedMap& sent);

  DeliveredPoints& points() { return points_; }
  Slot& slot() { return slot_; }
  const Slot& slot() const { return slot_; }

 private:
  Place* place_of(const Place& prepared);
  void put_back(Place& prepared);
  void work_done(const Place& prepared);
  void work_failed(const Place& prepared);
  void is_damaged(Place& place);
  void is_there(Place& place);

  loop::Loop& loop_;
  loop::Workers& workers_;
  const settings::Settings& settings_;
  TrafficCounts& counts_;
  UriPace& pace_;
  queues::MapQueue& queue_;
  MapStore& store_;
  std::function<void(bool is_done)> packed_;
  Slot slot_;
  DeliveredPoints points_;
  Place first_, following_;
  bool is_packing_ = false;
  loop::JobWatch packing_;
};

}  // namespace adit::forward
