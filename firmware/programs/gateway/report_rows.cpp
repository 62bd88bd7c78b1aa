#include "gateway/report_rows.hpp"

#include <algorithm>
#include <functional>
#include <ranges>
#include <utility>

#include "codec/read.hpp"
#include "dispatch/verdicts.hpp"

namespace adit::gateway {

const std::optional<icd::ReportReply>& ReadAnswers::answer_of(const dispatch::Report& report) {
  if (known_.size() >= kMost && !known_.contains(report.number)) known_.clear();
  const auto [found, is_new] = known_.try_emplace(report.number);
  CachedAnswer& known = found->second;
  if (!is_new && known.answer == report.answer) return known.reply;
  known = {.answer = report.answer, .reply = std::nullopt};
  if (report.answer.empty()) return known.reply;
  if (auto reply = codec::read_report_reply(report.answer)) known.reply = std::move(*reply);
  return known.reply;
}

facts::ReportRow row_of(const dispatch::Reports& reports, const dispatch::Report& report,
                        ReadAnswers& answers) {
  facts::ReportRow row{.number = report.number,
                       .type = report.report.type,
                       .position = report.is_lost() ? std::nullopt : std::optional(report.report.position),
                       .sender = report.sender,
                       .robot = icd::text_of(report.report.robot),
                       .received = report.received,
                       .changed = report.changed,
                       .state = std::string(dispatch::name_of(report.state)),
                       .status = report.status,
                       .report_status = "",
                       .score_change = std::nullopt,
                       .note = report.note,
                       .run = report.run,
                       .asking = reports.is_asking(report),
                       .sends_at = reports.sends_at(report),
                       .reconciled = report.reconciled,
                       .same_as = report.same_as};
  const bool is_recorded = report.state == dispatch::ReportState::Answered ||
                           (report.state == dispatch::ReportState::Settled && report.reconciled);
  const auto& reply = answers.answer_of(report);
  if (is_recorded && reply && !dispatch::is_about_another(*reply, report.report)) {
    row.report_status = reply->report_status;
    row.score_change = reply->score_change;
  }
  return row;
}

std::vector<facts::ReportRow> rows_after(const dispatch::Reports& reports, std::int64_t after,
                                         std::size_t most) {
  std::vector<facts::ReportRow> rows;
  ReadAnswers answers;
  const auto& all = reports.book().all();
  for (auto next = all.upper_bound(after); next != all.end() && rows.size() < most; ++next) {
    rows.push_back(row_of(reports, next->second, answers));
  }
  return rows;
}

api::ReportCounts counts_of(const dispatch::Reports& reports) {
  api::ReportCounts counts;
  for (std::size_t i = 0; i < counts.in.size(); ++i) {
    counts.in[i] = reports.book().count(static_cast<dispatch::ReportState>(i));
  }
  counts.asking = static_cast<std::uint64_t>(std::ranges::count_if(
      reports.book().open(),
      [&reports](std::int64_t number) { return reports.is_asking(reports.book().at(number)); }));
  return counts;
}

std::vector<const dispatch::Report*> latest_of(const dispatch::ReportBook& book, std::size_t most) {
  std::vector<const dispatch::Report*> chosen;
  for (const std::int64_t number : book.open()) chosen.push_back(&book.at(number));
  for (const auto& [number, report] : book.all() | std::views::reverse) {
    if (chosen.size() >= most) break;
    if (dispatch::is_final(report.state)) chosen.push_back(&report);
  }
  std::ranges::sort(chosen, std::greater(), &dispatch::Report::number);
  return chosen;
}

std::vector<facts::ReportRow> latest_rows(const dispatch::Reports& reports, std::size_t most,
                                          ReadAnswers& answers) {
  std::vector<facts::ReportRow> rows;
  for (const dispatch::Report* const report : latest_of(reports.book(), most)) {
    rows.push_back(row_of(reports, *report, answers));
  }
  return rows;
}

void set_time_of_day(facts::ReportRow& row, const forward::Clocks& clocks) {
  row.received = clocks.time_of_day(row.received);
  row.changed = clocks.time_of_day(row.changed);
  if (row.sends_at) row.sends_at = clocks.time_of_day(*row.sends_at);
}

std::optional<api::ReportDetail> detail_of(const dispatch::Reports& reports, const ledger::Ledger& ledger,
                                           std::int64_t number) {
  const dispatch::Report* const report = reports.book().find(number);
  if (report == nullptr) return std::nullopt;
  ReadAnswers answers;
  api::ReportDetail detail{.row = row_of(reports, *report, answers), .history = {}, .answer = report->answer};
  for (const auto& step : ledger.history(number)) detail.history.push_back({step.at, step.state, step.note});
  return detail;
}

}  // namespace adit::gateway
