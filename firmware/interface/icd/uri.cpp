#include "icd/uri.hpp"

#include <iterator>
#include <utility>

namespace adit::icd {
namespace {

struct Function {
  std::string_view method, path;
};

/// In the order of Uri.
constexpr Function kFunctions[] = {{"GET", "/api/status"},
                                   {"POST", "/api/artifact_reports"},
                                   {"POST", "/map/update"},
                                   {"POST", "/state/update"},
                                   {"POST", "/markers/update"}};
static_assert(std::size(kFunctions) == std::size(kUris));

}  // namespace

std::string_view path_of(Uri uri) {
  return kFunctions[std::to_underlying(uri)].path;
}

std::string_view method_of(Uri uri) {
  return kFunctions[std::to_underlying(uri)].method;
}

std::optional<Uri> uri_of(std::string_view path) {
  while (path.ends_with('/')) path.remove_suffix(1);
  for (const Uri uri : kUris) {
    if (path == path_of(uri)) return uri;
  }
  return std::nullopt;
}

}  // namespace adit::icd
