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
           (earlier.action != icd::MarkerAction::DeleteAll && places_.contains({earlier.ns, earlier.id}));
  }
  /// Whether a change of the same ns and id waits, or it is a DeleteAll: applying it adds no change.
  bool holds(const icd::Marker& marker) const {
    return marker.action == icd::MarkerAction::DeleteAll || places_.contains({marker.ns, marker.id});
  }
  const std::map<Place, icd::Marker>& in_order() const { return by_place_; }
  bool begins_with_delete_all() const;

 private:
  using Key = std::pair<std::string, std::int32_t>;  // ns and id (ICD 6.6)

  explicit MarkerChanges(Place next) : next_(next) {}
  std::size_t bytes_at(const Key& key) const;
  void insert(Place place, icd::Marker marker);
  icd::Marker extract(Place place);

  std::map<Place, icd::Marker> by_place_;
  std::map<Key, Place> places_;
  std::set<Place> deletes_;  // that are no DeleteAll
  Place next_ = 0;
  Size size_;
};

}  // namespace adit::lanes
