#pragma once

#include <string>

#include "api/run_view.hpp"
#include "cli/words.hpp"

namespace adit::cli {

Tone tone_of_level(alarms::Level level);

/// The output of `adit status`.
std::string status_text(const api::RunView& view, bool colour);

}  // namespace adit::cli
