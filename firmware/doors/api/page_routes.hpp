#pragma once

#include <span>

#include "intake/server.hpp"
#include "site/site.hpp"

/// The OpenAPI 3.1 description of the API, written by describe.jq at build time.
namespace adit::api::open_api {

using site::File;
std::span<const File> embedded_files();

inline const File& description() {
  return embedded_files().front();
}

}  // namespace adit::api::open_api

namespace adit::api {

/// Open to any client: the page's files, and the description of the API.
class PageRoutes {
 public:
  /// A file, by its path.
  intake::Answer file(const intake::RequestHead& head) const;
  intake::Answer description(const intake::RequestHead& head) const;
};

}  // namespace adit::api
