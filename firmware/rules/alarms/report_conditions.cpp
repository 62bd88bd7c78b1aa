// Decisions of the operator: reports, and messages that the Command Post rejected.
#include <algorithm>
#include <array>
#include <optional>
#include <ranges>

#include "alarms/conditions.hpp"
#include "dispatch/report.hpp"
#include "icd/sentence.hpp"

namespace adit::alarms {
namespace {

using facts::ReportRow;
using icd::sentence;

/// How a report needs the operator.
enum class Need : std::uint8_t { Held, InDoubt, Lost };
constexpr struct {
  const char *id, *state;
} kNeeds[] = {
    {"report_held", "held"},
    {"report_in_doubt", "in doubt"},
    {"report_lost", "lost"},
};

std::optional<Need> need_of(const ReportRow& row) {
  if (row.sends_at) return std::nullopt;
  if (row.state == dispatch::name_of(dispatch::ReportState::Held)) return Need::Held;
  if (row.state != dispatch::name_of(dispatch::ReportState::InDoubt)) return std::nullopt;
  return row.position ? Need::InDoubt : Need::Lost;
}

/// Whether the lost report stands for earlier ones also.
bool covers_several(const facts::Reports& reports, const ReportRow& lost) {
  return lost.number > 1 &&
         std::ranges::find(reports.rows, lost.number - 1, &ReportRow::number) == reports.rows.end();
}

Headline headline_of(Need need, const facts::Reports& reports, const ReportRow& row) {
  if (need == Need::Lost && covers_several(reports, row)) return {"Reports", "possibly missing", true};
  return {sentence("Report ", row.number), kNeeds[static_cast<std::size_t>(need)].state};
}

/// In the operator's words. A note begins with the request, and says later why it had no answer.
std::string reason_text(Need need, const facts::Reports& reports, const ReportRow& row) {
  if (need == Need::InDoubt && row.asking)
    return "its answer was lost, and the box asks for the run's status";
  if (need != Need::Lost) return row.note;
  const bool holds = reports.lost_here.contains(row.number);
  return sentence(holds ? "new reports are held until you " : "", "Settle report ", row.number, ": ",
                  row.note);
}

void find_undecided(const facts::Reports& reports, Conditions& found) {
  std::array<std::uint64_t, std::size(kNeeds)> count{};
  for (const ReportRow& row : reports.rows | std::views::reverse) {
    const auto need = need_of(row);
    if (!need || ++count.at(static_cast<std::size_t>(*need)) > kOneByOne) continue;
    const std::string number = std::to_string(row.number);
    found.push_back({.id = sentence(kNeeds[static_cast<std::size_t>(*need)].id, ":", number),
                     .severity = row.asking ? Severity::Wait : Severity::Ask,
                     .side = Side::CommandPost,
                     .subject = number,
                     .since = row.changed,
                     .headline = headline_of(*need, reports, row),
                     .why = reason_text(*need, reports, row),
                     .action = {row.asking ? "Show report" : "Decide", "/#report=" + number}});
  }
  for (std::size_t at = 0; at < std::size(kNeeds); ++at) {
    if (count.at(at) <= kOneByOne) continue;
    const std::uint64_t more = count.at(at) - kOneByOne;
    found.push_back({.id = sentence(kNeeds[at].id, ":more"),
                     .severity = Severity::Ask,
                     .side = Side::CommandPost,
                     .subject = "more",
                     .headline = {sentence(more, " more reports"), kNeeds[at].state, true},
                     .action = {"Show reports", "/#reports"},
                     .degree = more});
  }
}

void find_few_left(const facts::Reports& reports, Conditions& found) {
  if (!reports.left || *reports.left > kFewReports) return;
  const std::int64_t left = std::max<std::int64_t>(*reports.left, 0);
  found.push_back({.id = "reports_left",
                   .severity = left == 0 ? Severity::Bad : Severity::Wait,
                   .side = Side::CommandPost,
                   .headline = {left == 0   ? "No reports"
                                : left == 1 ? "1 report"
                                            : sentence(left, " reports"),
                                "left", left != 1},
                   .why = left == 0 ? "the Command Post scores no more reports of this run" : "in this run",
                   .degree = static_cast<std::uint64_t>(kFewReports - left)});
}

void find_elsewhere(const facts::Reports& reports, Conditions& found) {
  for (const auto& [post, count] : reports.elsewhere) {
    found.push_back({.id = "reports_elsewhere:" + post,
                     .severity = Severity::Ask,
                     .side = Side::CommandPost,
                     .subject = post,
                     .headline = {count == 1 ? "1 report" : sentence(count, " reports"), "for another server",
                                  count != 1},
                     .why = sentence("queued for ", post, ", which the settings do not name"),
                     .action = {"Open set-up", "/setup#post"},
                     .degree = count});
  }
}

void find_rejected(const std::vector<facts::RejectedRow>& rows, Conditions& found) {
  std::size_t count = 0;
  const facts::RejectedRow* newest = nullptr;
  for (const facts::RejectedRow& row : rows) {
    if (row.replaced || row.status == 0) continue;
    ++count;
    if (newest == nullptr || row.number >= newest->number) newest = &row;
  }
  if (newest == nullptr) return;
  found.push_back(
      {.id = "messages_rejected",
       .severity = Severity::Ask,
       .side = Side::CommandPost,
       .headline = {sentence(count, count == 1 ? " message" : " messages"), "rejected", count != 1},
       .why = sentence(count == 1 ? "" : "the newest: ", newest->robot.empty() ? "" : newest->robot + "'s ",
                       newest->kind, ": ", newest->why),
       .action = {"Show", "/#rejected"},
       .degree = newest->number});  // rises even if an older message made room
}

}  // namespace

void find_report_troubles(const facts::Reports& reports, Conditions& found) {
  find_undecided(reports, found);
  find_few_left(reports, found);
  find_elsewhere(reports, found);
  if (!reports.run_unreliable.empty()) {
    found.push_back({.id = "run_unreliable",
                     .severity = Severity::Ask,
                     .side = Side::CommandPost,
                     .headline = {"The count of reports", "uncertain"},
                     .why = reports.run_unreliable});
  }
  if (!reports.run_renamed.empty()) {
    found.push_back({.id = "run_renamed",
                     .severity = Severity::Ask,
                     .side = Side::CommandPost,
                     .headline = {"The name of the run", "uncertain"},
                     .why = reports.run_renamed});
  }
  find_rejected(reports.rejected, found);
}

}  // namespace adit::alarms
