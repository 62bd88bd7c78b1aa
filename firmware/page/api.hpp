#pragma once

#include "page/site.hpp"

/// The description of the API: OpenAPI 3.1, for programs that write clients.
namespace adit::page::api {

using page::File;
std::span<const File> embedded_files();

inline const File& description() {
  return embedded_files().front();
}

}  // namespace adit::page::api
