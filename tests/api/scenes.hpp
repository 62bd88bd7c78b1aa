#pragma once

#include <optional>
#include <string_view>

#include "api/run_view.hpp"

namespace adit::api {

/// A run as it might be `elapsed` seconds into a test, at `now` on the box's clock. Nothing where no scene
/// has that name: "empty", "calm", "trouble" or "hostile".
std::optional<RunView> scene(std::string_view name, Time now, double elapsed);

}  // namespace adit::api
