#pragma once

#include <string_view>
#include <vector>

#include "api/run_view.hpp"

namespace adit::cli {

/// What the operator can say of a report, by the words of `adit reports`: what the table of a report's life
/// has for where it is.
std::vector<std::string_view> verbs_for(const api::ReportRow& report);

}  // namespace adit::cli
