#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// A Point Cloud Library file, version 0.7, `DATA ascii` or `DATA binary`. Its VIEWPOINT becomes the cloud's
/// origin, as pcl_viewer takes it, unless it is the identity. Points that are NaN are left out.
std::expected<Cloud, std::string> parse_pcd(std::string_view bytes);

}  // namespace adit::robots
