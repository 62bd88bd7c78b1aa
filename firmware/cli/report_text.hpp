#pragma once

#include <string>

#include "page/page.hpp"

namespace adit::cli {

/// What `adit reports show` prints.
std::string report_text(const page::ReportDetail& detail, bool colour);

}  // namespace adit::cli
