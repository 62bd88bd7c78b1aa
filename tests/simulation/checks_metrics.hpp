#pragma once

#include "simulation/checks.hpp"

namespace adit::simulation {

/// Of Honest: the metrics say what the view says, where nothing happened between the two.
void judge_metrics(const Evidence& evidence, const Reading& reading, Broken& broken);

}  // namespace adit::simulation
