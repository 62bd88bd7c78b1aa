#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/route.hpp"

namespace adit::api {

/// The one table of routes: README.md has them in words, /adit/openapi.json for programs. Only the page's
/// files are not in it; anybody may have them.
std::span<const Route> routes();

/// What the table says of a request.
struct Match {
  const Route* route = nullptr;         // null: no such path, or another method
  std::vector<std::string> parameters;  // of the path, in its order
  std::string allowed;                  // of the path, as in RFC 9110 10.2.1: "GET, HEAD"; "": no such path
  Who who = Who::Operator;              // may ask; where there is no route, and be told so
};
Match match(const intake::RequestHead& head);

}  // namespace adit::api
