#pragma once

#include <vector>

#include "api/scene.hpp"

namespace adit::api {

/// Leaves out poses that lie on a straight way, so that interpolation in time between the others gives each
/// of them back (has_moved() tells no difference). A way is at most 10 s long. First and last pose stay.
Tracks thinned(std::vector<Track> tracks);

}  // namespace adit::api
