#pragma once

#include <cstdint>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

namespace adit::icd {

/// The five functions of the Command Post (ICD 5 and 6). The numbers are in files and must not change.
enum class Uri : std::uint8_t {
  Status = 0,
  ArtifactReports = 1,
  MapUpdate = 2,
  StateUpdate = 3,
  MarkersUpdate = 4,
};

inline constexpr Uri kUris[] = {Uri::Status, Uri::ArtifactReports, Uri::MapUpdate, Uri::StateUpdate,
                                Uri::MarkersUpdate};

struct Function {
  std::string_view method, path;
};
/// In the order of Uri. No path has a trailing slash.
inline constexpr Function kFunctions[] = {{"GET", "/api/status"},
                                          {"POST", "/api/artifact_reports"},
                                          {"POST", "/map/update"},
                                          {"POST", "/state/update"},
                                          {"POST", "/markers/update"}};
static_assert(std::size(kFunctions) == std::size(kUris));

constexpr std::string_view path_of(Uri uri) {
  return kFunctions[std::to_underlying(uri)].path;
}

constexpr std::string_view method_of(Uri uri) {
  return kFunctions[std::to_underlying(uri)].method;
}

/// The function that a request's path names. Trailing slashes are ignored.
constexpr std::optional<Uri> uri_of(std::string_view path) {
  while (path.ends_with('/')) path.remove_suffix(1);
  for (const Uri uri : kUris) {
    if (path == path_of(uri)) return uri;
  }
  return std::nullopt;
}

}  // namespace adit::icd
