#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "codec/field.hpp"
#include "page/page.hpp"

namespace adit::cli {

page::ReportRow read_report(const codec::Field& row);

/// What page::write_reports and page::write_report wrote, or why it is none.
std::expected<std::vector<page::ReportRow>, std::string> read_reports(std::string_view json);
std::expected<page::ReportDetail, std::string> read_report_detail(std::string_view json);

/// It stays where it is until the operator decides.
bool needs_the_operator(const page::ReportRow& report);
/// Nothing more happens to it, nor is there anything to decide.
bool is_finished(const page::ReportRow& report);

}  // namespace adit::cli
