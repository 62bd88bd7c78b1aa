#pragma once

#include "api/finer_map.hpp"
#include "api/route.hpp"
#include "api/source.hpp"

namespace adit::api {

/// The map, the markers and the robots' tracks: README.md.
class MapRoutes {
 public:
  /// Both must outlive this object.
  MapRoutes(const Source& source, FinerMap& finer) : source_(source), finer_(finer) {}

  intake::Answer layers(const intake::RequestHead& head) const;
  void tile(const Call& call) const;
  intake::Answer markers(const intake::RequestHead& head) const;
  intake::Answer tracks(const intake::RequestHead& head) const;

 private:
  const Source& source_;
  FinerMap& finer_;
};

}  // namespace adit::api
