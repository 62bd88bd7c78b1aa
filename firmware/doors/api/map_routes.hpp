#pragma once

#include "api/covered_map.hpp"
#include "api/finer_map.hpp"
#include "api/route.hpp"
#include "api/source.hpp"

namespace adit::api {

/// The map, the markers and the robots' tracks: README.md.
class MapRoutes {
 public:
  /// All must outlive this object.
  MapRoutes(const Source& source, FinerMap& finer, CoveredMap& covered)
      : source_(source), finer_(finer), covered_(covered) {}

  intake::Answer layers(const intake::RequestHead& head) const;
  void tile(const Call& call) const;
  void covered(const Call& call) const;
  intake::Answer markers(const intake::RequestHead& head) const;
  intake::Answer tracks(const intake::RequestHead& head) const;

 private:
  const Source& source_;
  FinerMap& finer_;
  CoveredMap& covered_;
};

}  // namespace adit::api
