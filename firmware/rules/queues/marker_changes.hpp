#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "icd/mapping.hpp"

namespace adit::queues {

/// Queued changes of the marker scene (ICD 6.6) in sending order, without needless ones. A newer change of
/// the same ns and id replaces an older one. DeleteAll replaces all earlier changes. A Delete behind a
/// DeleteAll is dropped. Law: on any scene, these changes have the same result as all changes that were
/// applied. Each change has a place, a number that rises in sending order. Only the first change can be a
/// DeleteAll.
class MarkerChanges {
 public:
  using Place = std::int64_t;

  MarkerChanges() = default;

  struct Size {
    std::size_t count = 0;  // changes
    std::size_t bytes = 0;  // the sum of icd::bytes_of()
    friend bool operator==(const Size&, const Size&) = default;
  };

  /// Adds a change behind all others. Returns the place of the change that now stands for it, or of the
  /// DeleteAll that made it needless.
  Place apply(icd::Marker marker);
  /// The same for a DeleteAll. Returns the changes that became needless, because freeing many of them takes
  /// long.
  MarkerChanges wipe(icd::Marker delete_all);
  /// The same as if `older` had been applied first. Returns a place behind the changes of `older` and before
  /// all others. The cost grows with `older`, not with the queue.
  Place apply_before(MarkerChanges older);

  /// Takes out the change of the same ns and id, or the DeleteAll, if there is one.
  std::optional<icd::Marker> remove(const icd::Marker& like);
  /// Takes out the first changes: at most `most.count`, and at most `most.bytes` unless the first is larger.
  std::vector<icd::Marker> take(Size most);

  Size size() const { return size_; }
  /// size() as it would be after applying `newer`.
  Size size_with(const std::vector<icd::Marker>& newer) const;
  bool empty() const { return by_place_.empty(); }
  /// Whether a queued change makes an earlier change of that marker needless.
  bool says_more_than(const icd::Marker& earlier) const {
    return begins_with_delete_all() ||
           (earlier.action != icd::MarkerAction::DeleteAll && places_.contains(earlier));
  }
  /// Whether apply() would add no change: a change of the same ns and id is queued, or `marker` is a
  /// DeleteAll.
  bool holds(const icd::Marker& marker) const {
    return marker.action == icd::MarkerAction::DeleteAll || places_.contains(marker);
  }
  const std::map<Place, icd::Marker>& in_order() const { return by_place_; }
  bool begins_with_delete_all() const;

 private:
  /// A marker's identity (ICD 6.6). The id is compared first because most ids differ.
  struct Key {
    std::string ns;
    std::int32_t id = 0;
  };
  struct ByKey {
    using is_transparent = void;
    template <class A, class B>
    bool operator()(const A& a, const B& b) const {
      return a.id != b.id ? a.id < b.id : a.ns < b.ns;
    }
  };
  using InOrder = std::map<Place, icd::Marker>;
  using Places = std::map<Key, Place, ByKey>;

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

}  // namespace adit::queues
