#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/route.hpp"

namespace adit::api {

/// The table of all routes. README.md describes them, /adit/openapi.json describes them for programs. The
/// page's files are not in it and are open to all.
std::span<const Route> routes();

/// A request's place in the table.
struct Match {
  const Route* route = nullptr;             // null: no such path or method
  std::vector<std::string> parameters;      // of the path, in order
  std::string allowed;                      // methods of the path (RFC 9110 10.2.1): "GET, HEAD"; "": no such
                                            // path
  RouteAccess who = RouteAccess::Operator;  // clients that may use it, or learn that there is no route
};
Match match(const intake::RequestHead& head);

}  // namespace adit::api
