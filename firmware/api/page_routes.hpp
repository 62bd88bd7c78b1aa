#pragma once

#include <string>

#include "intake/server.hpp"

namespace adit::api {

/// What is for anybody: the page's files, and the description of the API.
class PageRoutes {
 public:
  /// Any of the files, by its path.
  intake::Answer file(const intake::RequestHead& head);
  intake::Answer description(const intake::RequestHead& head);

 private:
  std::string description_, description_etag_;  // once it was asked for
};

}  // namespace adit::api
