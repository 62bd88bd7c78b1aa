#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "api/run_view.hpp"

namespace adit::cli {

/// A line for each thing that changed from one view to the next, with the time of day; "" where nothing did.
std::string changes_text(const api::RunView& before, const api::RunView& now, bool colour);

/// As much of `text` as a screen of that size shows, which ends without a line's end: longer lines are cut,
/// and in place of the last a line says how many more there are. Colours count for nothing.
std::string fitted(std::string_view text, std::size_t rows, std::size_t columns);

}  // namespace adit::cli
