#pragma once

#include <span>

#include "site/site.hpp"

/// The OpenAPI 3.1 description of the API, written by describe.jq at build time.
namespace adit::api::open_api {

using site::File;
std::span<const File> embedded_files();

inline const File& description() {
  return embedded_files().front();
}

}  // namespace adit::api::open_api
