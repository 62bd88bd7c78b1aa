#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace adit::settings {

/// The one of `known` that `name` was likely meant to be: a few letters differ, or one begins with the other.
std::optional<std::string_view> nearest(std::string_view name, std::span<const std::string_view> known);

}  // namespace adit::settings
