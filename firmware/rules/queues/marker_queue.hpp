#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "icd/mapping.hpp"
#include "queues/blame.hpp"
#include "queues/map_queue.hpp"

namespace adit::queues {

/// Queued changes of the marker scene (ICD 6.6) in sending order, without needless ones. A newer change of
/// the same ns and id replaces an older one. DeleteAll replaces all earlier changes; a Delete behind it is
/// dropped. Law: on any scene, these changes have the same result as all that were applied. Each change has a
/// place, which rises in sending order. Only the first change can be a DeleteAll.
class MarkerChanges {
 public:
  using Place = std::int64_t;

  MarkerChanges() = default;

  struct Size {
    std::size_t count = 0;  // changes
    std::size_t bytes = 0;  // the sum of icd::bytes_of()
    friend bool operator==(const Size&, const Size&) = default;
  };

  /// Adds a change behind all others. Returns the place of the change, or DeleteAll, that stands for it.
  Place apply(icd::Marker marker);
  /// The same for a DeleteAll. Returns the needless changes, because freeing many of them takes long.
  MarkerChanges wipe(icd::Marker delete_all);
  /// The same as if `older` had been applied first. Returns a place behind the changes of `older` and before
  /// all others. The cost grows with `older`, not with the queue.
  Place apply_before(MarkerChanges older);

  /// Takes out the change of the same ns and id, or the DeleteAll, if there is one.
  std::optional<icd::Marker> remove(const icd::Marker& like);
  /// Takes out the first changes: at most `most.count`, and at most `most.bytes` unless the first is larger.
  std::vector<icd::Marker> pop(Size most);

  Size size() const { return size_; }
  /// size() as it would be after applying `newer`.
  Size size_with(const std::vector<icd::Marker>& newer) const;
  bool empty() const { return by_place_.empty(); }
  /// Whether a queued change makes an earlier change of that marker needless.
  bool supersedes(const icd::Marker& earlier) const {
    return begins_with_delete_all() ||
           (earlier.action != icd::MarkerAction::DeleteAll && places_.contains(earlier));
  }
  /// Whether apply() would add no change: one of that ns and id is queued, or `marker` is a DeleteAll.
  bool holds(const icd::Marker& marker) const {
    return marker.action == icd::MarkerAction::DeleteAll || places_.contains(marker);
  }
  const std::map<Place, icd::Marker>& changes_by_place() const { return by_place_; }
  bool begins_with_delete_all() const;

 private:
  /// A marker's identity (ICD 6.6). The id is compared first because most ids differ.
  struct Key {
    std::string ns;
    std::int32_t id = 0;
  };
  struct KeyLess {
    using is_transparent = void;
    template <class A, class B>
    bool operator()(const A& a, const B& b) const {
      return a.id != b.id ? a.id < b.id : a.ns < b.ns;
    }
  };
  using InOrder = std::map<Place, icd::Marker>;
  using Places = std::map<Key, Place, KeyLess>;

  std::size_t bytes_at(const Key& key) const;
  /// `marker` is not in places_; `next`: the first key there that follows.
  void insert(Place place, icd::Marker&& marker, Places::const_iterator next);
  void insert(Place place, icd::Marker&& marker) {
    const auto next = places_.lower_bound(marker);
    insert(place, std::move(marker), next);
  }
  void replace(InOrder::iterator older, icd::Marker&& marker);
  icd::Marker extract(InOrder::iterator change);
  icd::Marker extract(Place place) { return extract(by_place_.find(place)); }

  InOrder by_place_;
  Places places_;
  std::set<Place> deletes_;  // the places of Delete changes
  Place next_ = 0;
  Size size_;
};

/// The accepted marker updates with queued changes, by the place of their last change. An update is done once
/// all changes up to that place were taken out of the queue.
class QueuedUpdates {
 public:
  using Place = MarkerChanges::Place;
  static constexpr auto kNowhere = std::numeric_limits<Place>::min();

  /// Adds `count` updates that end at `last`; `accepted`: when the oldest of them was accepted.
  void add(Place last, std::uint64_t count, Instant accepted);
  /// Moves the end of the first updates to `last`.
  void move_first_to(Place last);
  /// Removes the updates that end before the first of `changes`, and returns their number.
  std::uint64_t remove_done(const MarkerChanges& changes);
  /// If an update's last change is gone, it ends at the change before. This bounds the number of ends.
  void join(const MarkerChanges& changes);

  bool empty() const { return by_end_.empty(); }
  std::optional<Instant> oldest() const {
    return accepted_.empty() ? std::nullopt : std::optional(*accepted_.begin());
  }

 private:
  struct Updates {
    std::uint64_t count = 0;
    Instant accepted;  // of the oldest
  };
  using ByEnd = std::map<Place, Updates>;

  Updates extract(ByEnd::iterator updates);

  ByEnd by_end_;
  std::multiset<Instant> accepted_;  // of each
};

struct QueuedMarkers {
  icd::MarkersUpdate update;
  Instant accepted;           // when the oldest news in it was accepted
  std::uint64_t updates = 0;  // how many accepted updates are complete with this message
  bool is_ahead = false;      // a copy of a queued change, sent ahead of the others
};

/// Lifetimes begin at `now`, when the markers are accepted.
void start_lifetimes(std::span<icd::Marker> accepted, icd::Stamp now);

/// Limits of the marker queue. Bytes are those of icd::bytes_of().
struct MarkerBounds {
  std::size_t per_message = 2000;           // markers; at least 1
  std::size_t bytes_per_message = 1 << 20;  // unless a single marker is larger
  std::size_t bytes = 32 << 20;             // of all queued changes
};

/// The queued changes of markers, oldest first.
class MarkerQueue {
 public:
  static constexpr std::size_t kMostMarkers = 100'000;
  static constexpr double kLeastLifetime = 0.1;  // seconds

  explicit MarkerQueue(MarkerBounds bounds) : bounds_(bounds), most_now_(bounds.per_message) {}

  /// Sets new limits. Queued changes stay.
  void set_bounds(MarkerBounds bounds);

  /// Whether the limits allow `update`, so that no sender can fill the memory while the Command Post is away.
  /// A quarter of the bytes is reserved for updates that only replace queued changes: a growing path is
  /// accepted after new markers are not. An empty queue has room for any update.
  bool has_room_for(const icd::MarkersUpdate& update) const;
  /// For an update without room: its changes of markers that are queued already, so that a full queue holds
  /// the newest change of each. Changes before the last DeleteAll are left out.
  icd::MarkersUpdate queued_changes(const icd::MarkersUpdate& update) const;
  void add(icd::MarkersUpdate update, Instant now);
  /// Adds a part of a large update, because all of it would block the loop. Moves from `some`. `last`: the
  /// previous part's result, or kNowhere. Call end_of_update() after the last part, and no pop() before.
  MarkerChanges::Place add_part(std::span<icd::Marker> some, MarkerChanges::Place last);
  void end_of_update(MarkerChanges::Place last, Instant now);
  /// The changes made needless by DeleteAll since the last call. Freeing takes long; any thread may do it.
  std::vector<MarkerChanges> needless() { return std::exchange(needless_, {}); }
  /// Takes the oldest changes out, in order; nullopt if the queue is empty. A lifetime is reduced to the rest
  /// that remains at `now`, at least kLeastLifetime. An expired marker becomes a Delete, because an older one
  /// of its ns and id may be shown, and Adit cannot know that after a restart.
  std::optional<QueuedMarkers> pop(icd::Stamp now);
  /// Queues the result of the last pop() again, which was not delivered: ahead of newer changes, and merged
  /// with them. The cost grows with `markers`, not with the queue.
  void put_back(const QueuedMarkers& markers);
  /// The same, and halves the number in a message, so that the rejected marker is found.
  void put_back_narrower(const QueuedMarkers& markers);
  /// Queues a single failed change behind all others, unless they make it needless. A DeleteAll stays first,
  /// because later changes depend on it. Instead, pop() gives a copy of one later change once, in turn, to
  /// find out whether others are accepted. The result at the Command Post is the same.
  void requeue_last(const QueuedMarkers& markers);
  bool supersedes(const icd::Marker& earlier) const { return changes_.supersedes(earlier); }
  /// The last message was accepted: the next one may have twice as many markers.
  void on_passed() { most_now_ = std::min(bounds_.per_message, most_now_ * 2); }

  std::size_t count() const { return changes_.size().count; }  // queued changes
  std::size_t bytes() const { return changes_.size().bytes; }
  /// All queued changes, in order.
  std::vector<icd::Marker> pending() const;
  std::optional<Instant> oldest() const { return updates_.oldest(); }
  bool empty() const { return updates_.empty(); }

 private:
  std::optional<icd::Marker> copy_later_change();

  MarkerBounds bounds_;
  std::size_t most_now_;       // markers in the next message
  bool may_go_ahead_ = false;  // the first change is a DeleteAll that failed: another one goes once
  MarkerChanges::Place ahead_ = QueuedUpdates::kNowhere;  // of the last change that went ahead
  MarkerChanges changes_;
  QueuedUpdates updates_;
  std::vector<MarkerChanges> needless_;
};

}  // namespace adit::queues
