#pragma once

#include "simulation/checks.hpp"

namespace adit::simulation {

/// Part of Honest: the metrics agree with the view, if no event happened between the two.
void check_metrics(const Evidence& evidence, const Reading& reading, Broken& broken);

}  // namespace adit::simulation
