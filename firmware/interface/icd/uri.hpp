#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

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

/// "/api/status", "/map/update", ... without a trailing slash.
std::string_view path_of(Uri uri);

/// "GET" for Status, "POST" for the others.
std::string_view method_of(Uri uri);

/// The function that a request's path names. Trailing slashes are ignored.
std::optional<Uri> uri_of(std::string_view path);

}  // namespace adit::icd
