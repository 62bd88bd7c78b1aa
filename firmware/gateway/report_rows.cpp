#include "gateway/report_rows.hpp"

#include <algorithm>
#include <ranges>

#include "codec/read.hpp"

namespace adit::gateway {

api::ReportRow row_of(const dispatch::Reports& reports, const dispatch::Report& report) {
  api::ReportRow row{.number = report.number,
                     .type = report.report.type,
                     .position = report.is_lost() ? std::nullopt : std::optional(report.report.position),
                     .sender = report.sender,
                     .received = report.received,
                     .changed = report.changed,
                     .state = std::string(dispatch::name_of(report.state)),
                     .status = report.status,
                     .report_status = "",
                     .score_change = std::nullopt,
                     .note = report.note,
                     .run = report.run,
                     .asking = reports.is_asking(report),
                     .reconciled = report.reconciled,
                     .same_as = report.same_as};
  if (report.answer.empty()) return row;
  if (const auto reply = codec::read_report_reply(report.answer)) {
    row.report_status = reply->report_status;
    row.score_change = reply->score_change;
  }
  return row;
}

std::vector<api::ReportRow> all_rows(const dispatch::Reports& reports) {
  std::vector<api::ReportRow> rows;
  for (const auto& [number, report] : reports.book().all()) rows.push_back(row_of(reports, report));
  return rows;
}

std::vector<const dispatch::Report*> latest_of(const std::map<std::int64_t, dispatch::Report>& all,
                                               std::size_t most) {
  const auto is_open = [](const auto& item) { return !dispatch::is_final(item.second.state); };
  const auto open = static_cast<std::size_t>(std::ranges::count_if(all, is_open));
  std::size_t room = most - std::min(most, open);  // for those that are done
  std::vector<const dispatch::Report*> chosen;
  for (const auto& item : all | std::views::reverse) {
    if (chosen.size() == most) break;
    if (!is_open(item) && room == 0) continue;
    if (!is_open(item)) --room;
    chosen.push_back(&item.second);
  }
  return chosen;
}

std::vector<api::ReportRow> latest_rows(const dispatch::Reports& reports, std::size_t most) {
  std::vector<api::ReportRow> rows;
  for (const dispatch::Report* const report : latest_of(reports.book().all(), most)) {
    rows.push_back(row_of(reports, *report));
  }
  return rows;
}

std::optional<api::ReportDetail> detail_of(const dispatch::Reports& reports, const ledger::Ledger& ledger,
                                           std::int64_t number) {
  const dispatch::Report* const report = reports.book().find(number);
  if (report == nullptr) return std::nullopt;
  api::ReportDetail detail{.row = row_of(reports, *report), .history = {}, .answer = report->answer};
  if (const auto history = ledger.history(number)) {
    for (const auto& step : *history) detail.history.push_back({step.at, step.state, step.note});
  }
  return detail;
}

}  // namespace adit::gateway
