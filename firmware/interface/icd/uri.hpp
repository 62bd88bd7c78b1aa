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

/// The Command Post's two servers.
enum class Endpoint : std::uint8_t {
  Scoring,  // ICD 5: a run and its reports, in JSON
  Mapping,  // ICD 6: data that newer data may replace, in JSON or CBOR
};

struct Function {
  Endpoint endpoint;
  std::string_view method, path;
};
/// In the order of Uri. No path has a trailing slash.
inline constexpr Function kFunctions[] = {{Endpoint::Scoring, "GET", "/api/status"},
                                          {Endpoint::Scoring, "POST", "/api/artifact_reports"},
                                          {Endpoint::Mapping, "POST", "/map/update"},
                                          {Endpoint::Mapping, "POST", "/state/update"},
                                          {Endpoint::Mapping, "POST", "/markers/update"}};
static_assert(std::size(kFunctions) == std::size(kUris));

constexpr std::string_view path_of(Uri uri) {
  return kFunctions[std::to_underlying(uri)].path;
}

constexpr std::string_view method_of(Uri uri) {
  return kFunctions[std::to_underlying(uri)].method;
}

constexpr Endpoint endpoint_of(Uri uri) {
  return kFunctions[std::to_underlying(uri)].endpoint;
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
