#pragma once

#include <string>

#include "page/page.hpp"

namespace adit::cli {

/// What `adit reports` prints.
std::string reports_text(const page::RunView& view, bool colour);

/// Whether the operator must decide about one.
bool any_in_doubt(const page::RunView& view);

}  // namespace adit::cli
