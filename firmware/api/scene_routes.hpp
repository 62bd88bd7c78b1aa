#pragma once

#include <string_view>

#include "api/source.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// Markers and robots' tracks, for those whom Entrance let in: README.md.
class SceneRoutes {
 public:
  /// `source` outlives this.
  explicit SceneRoutes(const Source& source) : source_(source) {}

  static bool has(std::string_view path);
  /// Requires has(head.path()).
  intake::Answer answer(const intake::RequestHead& head) const;

 private:
  const Source& source_;
};

}  // namespace adit::api
