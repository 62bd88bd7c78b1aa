#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>

namespace adit::access {

using Instant = std::chrono::steady_clock::time_point;
using Duration = std::chrono::nanoseconds;

/// A viewer looks. An operator also acts. Each role includes the previous ones.
enum class Role : std::uint8_t { Viewer, Operator };

/// "viewer", "operator"
std::string_view name_of(Role role);
std::optional<Role> role_named(std::string_view name);

}  // namespace adit::access
