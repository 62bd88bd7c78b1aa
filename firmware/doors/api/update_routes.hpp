#pragma once

#include <memory>

#include "api/route.hpp"
#include "api/updates.hpp"

namespace adit::api {

/// Updates of the box: README.md.
namespace update_routes {

/// Receives a bundle as a stream. `updates` must outlive the result.
std::unique_ptr<intake::BodySink> receive(Updates& updates, const Call& call);

}  // namespace update_routes
}  // namespace adit::api
