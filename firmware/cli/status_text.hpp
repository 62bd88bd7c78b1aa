#pragma once

#include <string>

#include "api/run_view.hpp"

namespace adit::cli {

/// What `adit status` prints.
std::string status_text(const api::RunView& view, bool colour);

}  // namespace adit::cli
