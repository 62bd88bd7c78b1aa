#pragma once

#include "intake/server.hpp"

namespace adit::api {

/// What is for anybody: the page's files, and the description of the API.
class PageRoutes {
 public:
  /// Any of the files, by its path.
  intake::Answer file(const intake::RequestHead& head) const;
  intake::Answer description(const intake::RequestHead& head) const;
};

}  // namespace adit::api
