#pragma once

#include "intake/server.hpp"

namespace adit::api {

/// Open to any client: the page's files, and the description of the API.
class PageRoutes {
 public:
  /// A file, by its path.
  intake::Answer file(const intake::RequestHead& head) const;
  intake::Answer description(const intake::RequestHead& head) const;
};

}  // namespace adit::api
