#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "api/run_view.hpp"
#include "codec/field.hpp"

namespace adit::cli {

api::ReportRow read_report(const codec::Field& row);

/// What api::write_reports and api::write_report wrote, or why it is none.
std::expected<std::vector<api::ReportRow>, std::string> read_reports(std::string_view json);
std::expected<api::ReportDetail, std::string> read_report_detail(std::string_view json);

/// It stays where it is until the operator decides.
bool needs_the_operator(const api::ReportRow& report);
/// Nothing more happens to it, nor is there anything to decide.
bool is_finished(const api::ReportRow& report);

}  // namespace adit::cli
