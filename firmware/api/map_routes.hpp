#pragma once

#include <string_view>

#include "api/source.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// The picture of the maps, for those whom Entrance let in: README.md. Answers at once, and draws nothing.
class MapRoutes {
 public:
  /// `source` outlives this.
  explicit MapRoutes(const Source& source) : source_(source) {}

  static bool has(std::string_view path);
  /// Requires has(head.path()).
  intake::Answer answer(const intake::RequestHead& head) const;

 private:
  intake::Answer layers(const intake::RequestHead& head) const;
  intake::Answer tile(const intake::RequestHead& head) const;

  const Source& source_;
};

}  // namespace adit::api
