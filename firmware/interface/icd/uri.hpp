#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
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

/// The Command Post's two servers.
enum class Endpoint : std::uint8_t {
  Scoring,  // ICD 5: a run and its reports, in JSON
  Mapping,  // ICD 6: data that newer data may replace, in JSON or CBOR
};

/// The body of a 2xx answer.
enum class Reply : std::uint8_t { RunStatus, Report, Null };

struct Function {
  Uri uri;
  Endpoint endpoint;
  std::string_view method, path;
  Reply reply;
};
/// In the order of Uri. No path has a trailing slash.
inline constexpr Function kFunctions[] = {
    {Uri::Status, Endpoint::Scoring, "GET", "/api/status", Reply::RunStatus},
    {Uri::ArtifactReports, Endpoint::Scoring, "POST", "/api/artifact_reports", Reply::Report},
    {Uri::MapUpdate, Endpoint::Mapping, "POST", "/map/update", Reply::Null},
    {Uri::StateUpdate, Endpoint::Mapping, "POST", "/state/update", Reply::Null},
    {Uri::MarkersUpdate, Endpoint::Mapping, "POST", "/markers/update", Reply::Null}};

inline constexpr auto kUris = [] {
  std::array<Uri, std::size(kFunctions)> uris{};
  std::ranges::transform(kFunctions, uris.begin(), &Function::uri);
  return uris;
}();
static_assert([] {
  for (std::size_t i = 0; i < kUris.size(); ++i) {
    if (std::to_underlying(kUris[i]) != i) return false;
  }
  return true;
}());

constexpr std::string_view path_of(Uri uri) {
  return kFunctions[std::to_underlying(uri)].path;
}

constexpr std::string_view method_of(Uri uri) {
  return kFunctions[std::to_underlying(uri)].method;
}

constexpr Endpoint endpoint_of(Uri uri) {
  return kFunctions[std::to_underlying(uri)].endpoint;
}

constexpr Reply reply_of(Uri uri) {
  return kFunctions[std::to_underlying(uri)].reply;
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
