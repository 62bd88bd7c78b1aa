#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// The vertices of a PLY file, `ascii` or `binary_little_endian`; they must be its first element. Other
/// elements are left out.
std::expected<Cloud, std::string> parse_ply(std::string_view bytes);

}  // namespace adit::robots
