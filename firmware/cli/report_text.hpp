#pragma once

#include <string>

#include "api/run_view.hpp"

namespace adit::cli {

/// What `adit reports show` prints.
std::string report_text(const api::ReportDetail& detail, bool colour);

}  // namespace adit::cli
