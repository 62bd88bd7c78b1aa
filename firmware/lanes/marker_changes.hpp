#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "icd/markers_update.hpp"

namespace adit::lanes {

/// Changes of the markers' scene in the order in which they are to be sent, as few as say the same. Each has
/// a place: a number that rises along the order. A DeleteAll can only be the first.
class MarkerChanges {
 public:
  using Place = std::int64_t;

  /// Adds a change that comes after all others; gives the place of the change that stands for it, or of the
  /// DeleteAll that made it needless.
  Place apply(const icd::Marker& marker);

  /// Takes the first `most` out.
  std::vector<icd::Marker> take(std::size_t most);

  std::size_t count() const { return by_place_.size(); }
  bool empty() const { return by_place_.empty(); }
  const std::map<Place, icd::Marker>& in_order() const { return by_place_; }

 private:
  using Key = std::pair<std::string, std::int32_t>;  // ns and id (ICD 6.6)
  bool begins_with_delete_all() const;

  std::map<Place, icd::Marker> by_place_;
  std::map<Key, Place> places_;
  Place next_ = 0;
};

}  // namespace adit::lanes
