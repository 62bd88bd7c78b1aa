#pragma once

#include "alarms/found.hpp"

namespace adit::alarms {

/// Takes out what follows from a larger cause that is there, too, and counts it there. The cable before the
/// endpoint, the endpoint before the maps and robots.
void hide_consequences(Found& found);

}  // namespace adit::alarms
