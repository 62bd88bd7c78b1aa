#pragma once

#include <span>
#include <string>

#include "api/route.hpp"

namespace adit::api {

/// The API described for programs, by OpenAPI 3.1 (JSON): `paths` is made of the routes, what they have in
/// common is openapi.json, the messages' schemas are schemas.json.
std::string write_description(std::span<const Route> routes);

}  // namespace adit::api
