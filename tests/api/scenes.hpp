#pragma once

#include <optional>
#include <string_view>

#include "api/run_view.hpp"

namespace adit::api {

/// An example run, `elapsed` seconds into a test, at `now` on the box's clock. Scenes: "empty", "calm",
/// "trouble", "hostile"; nullopt for other names.
std::optional<RunView> scene(std::string_view name, Time now, double elapsed);

}  // namespace adit::api
