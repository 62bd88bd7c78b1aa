#pragma once

#include "api/route.hpp"
#include "api/source.hpp"

namespace adit::api {

/// The picture of the maps, the markers and the robots' tracks: README.md. Draws nothing.
class MapRoutes {
 public:
  /// `source` outlives this.
  explicit MapRoutes(const Source& source) : source_(source) {}

  intake::Answer layers(const intake::RequestHead& head) const;
  intake::Answer tile(const Call& call) const;
  intake::Answer markers(const intake::RequestHead& head) const;
  intake::Answer tracks(const intake::RequestHead& head) const;

 private:
  const Source& source_;
};

}  // namespace adit::api
