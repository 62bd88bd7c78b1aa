#include "icd/uri.hpp"

namespace adit::icd {

std::string_view path_of(Uri uri) {
  switch (uri) {
    case Uri::Status:
      return "/api/status";
    case Uri::ArtifactReports:
      return "/api/artifact_reports";
    case Uri::MapUpdate:
      return "/map/update";
    case Uri::StateUpdate:
      return "/state/update";
    case Uri::MarkersUpdate:
      return "/markers/update";
  }
  return {};
}

std::string_view method_of(Uri uri) {
  return uri == Uri::Status ? "GET" : "POST";
}

std::optional<Uri> uri_of(std::string_view path) {
  while (path.ends_with('/')) path.remove_suffix(1);
  for (const Uri uri : kUris) {
    if (path == path_of(uri)) return uri;
  }
  return std::nullopt;
}

}  // namespace adit::icd
