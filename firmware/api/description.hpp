#pragma once

#include <span>

#include "site/site.hpp"

/// The description of the API, OpenAPI 3.1: describe.jq writes it at build time.
namespace adit::api::open_api {

using site::File;
std::span<const File> embedded_files();

inline const File& description() {
  return embedded_files().front();
}

}  // namespace adit::api::open_api
