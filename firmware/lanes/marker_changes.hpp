#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "icd/markers_update.hpp"

namespace adit::lanes {

/// Changes of the markers' scene (ICD 6.6) in the order in which they are to be sent, with no needless ones:
/// a newer change of the same ns and id replaces an older one, DeleteAll replaces all before it, and nothing
/// is deleted that a DeleteAll before it has deleted. Law: replaying them on any scene gives the same as
/// replaying all that were applied. Each has a place, a number that rises along the order. Only the first can
/// be a DeleteAll.
class MarkerChanges {
 public:
  using Place = std::int64_t;

  MarkerChanges() = default;

  struct Size {
    std::size_t count = 0;  // of changes
    std::size_t bytes = 0;  // icd::bytes_of all of them
    friend bool operator==(const Size&, const Size&) = default;
  };

  /// Adds a change that comes after all others; gives the place of the change that stands for it, or of the
  /// DeleteAll that made it needless.
  Place apply(icd::Marker marker);
  /// The same for a DeleteAll, and gives what it made needless: to free much of that takes long.
  MarkerChanges wipe(icd::Marker delete_all);
  /// As if all of `older` had been applied before the others; gives a place that is after all that came of
  /// it, and before all others. Costs by what is in `older`, not by what waits.
  Place apply_before(MarkerChanges older);

  /// Takes out the change of the same ns and id, or the DeleteAll, where there is one.
  std::optional<icd::Marker> remove(const icd::Marker& like);
  /// Takes the first `most.count` out, and no more than `most.bytes` of them, but at least one.
  std::vector<icd::Marker> take(Size most);

  Size size() const { return size_; }
  /// What size() would be after `newer` had been applied.
  Size size_with(const std::vector<icd::Marker>& newer) const;
  bool empty() const { return by_place_.empty(); }
  /// Whether what waits makes an earlier change of that marker needless.
  bool says_more_than(const icd::Marker& earlier) const {
    return begins_with_delete_all() ||
           (earlier.action != icd::MarkerAction::DeleteAll && places_.contains(earlier));
  }
  /// Whether a change of the same ns and id waits, or it is a DeleteAll: applying it adds no change.
  bool holds(const icd::Marker& marker) const {
    return marker.action == icd::MarkerAction::DeleteAll || places_.contains(marker);
  }
  const std::map<Place, icd::Marker>& in_order() const { return by_place_; }
  bool begins_with_delete_all() const;

 private:
  /// Of ns and id (ICD 6.6), as a marker has them; the id first, which alone tells most of them apart.
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
  /// `next`: the first in places_ that is after it, of a marker that is not there.
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
  std::set<Place> deletes_;  // that are no DeleteAll
  Place next_ = 0;
  Size size_;
};

}  // namespace adit::lanes
