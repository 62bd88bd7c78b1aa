#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "api/run_view.hpp"
#include "cli/table.hpp"

namespace adit::cli {

Tone tone_of_level(alarms::Level level);

/// The output of `adit status`.
std::string status_text(const api::RunView& view, bool colour);

/// A line with the time of day for each change between two views, or "".
std::string changes_text(const api::RunView& before, const api::RunView& now, bool colour);

/// The part of `text` that fits a screen of that size, without a final newline. Long lines are cut. The last
/// line says how many lines are missing. Colour sequences have no width.
std::string fitted(std::string_view text, std::size_t rows, std::size_t columns);

}  // namespace adit::cli
