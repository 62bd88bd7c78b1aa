// Decisions of the operator: reports, and messages that the Command Post rejected.
#include <array>

#include "alarms/conditions.hpp"
#include "icd/sentence.hpp"

namespace adit::alarms {
namespace {

using icd::sentence;
using Is = ReportFact::Is;

constexpr const char* kCallDone = "; mark it as done";
constexpr const char* kUntilDone = "; until you mark it as done, new reports of this run are held";

constexpr struct {
  Is is;
  const char *id, *state;
} kStates[] = {
    {Is::Held, "report_held", "held"},
    {Is::InDoubt, "report_in_doubt", "in doubt"},
    {Is::Lost, "report_lost", "lost"},
};

std::string why(const ReportFact& report) {
  if (report.is == Is::Lost) return report.note + (report.of_run ? kUntilDone : kCallDone);
  return report.note;
}

void find_undecided(const Facts& facts, Found& found) {
  std::array<std::uint64_t, std::size(kStates)> count{};
  for (const ReportFact& report : facts.reports) {
    const auto at = static_cast<std::size_t>(report.is);
    if (++count.at(at) > kOneByOne) continue;
    const std::string number = std::to_string(report.number);
    found.push_back({.id = sentence(kStates[at].id, ":", number),
                     .severity = report.asking ? Severity::Wait : Severity::Ask,
                     .side = report.is == Is::InDoubt ? Side::CommandPost : Side::Box,
                     .subject = number,
                     .since = report.since,
                     .headline = {"Report " + number, kStates[at].state},
                     .why = why(report),
                     .action = {report.asking ? "Show report" : "Decide", "/#report=" + number}});
  }
  for (std::size_t at = 0; at < std::size(kStates); ++at) {
    if (count.at(at) <= kOneByOne) continue;
    const std::uint64_t more = count.at(at) - kOneByOne;
    found.push_back({.id = sentence(kStates[at].id, ":more"),
                     .severity = Severity::Ask,
                     .side = Side::Box,
                     .subject = "more",
                     .headline = {sentence(more, " more reports"), kStates[at].state, true},
                     .action = {"Show reports", "/#reports"},
                     .degree = more});
  }
}

void find_few_left(const Facts& facts, Found& found) {
  if (!facts.reports_left || *facts.reports_left > kFewReports) return;
  const std::int64_t left = std::max<std::int64_t>(*facts.reports_left, 0);
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

void find_elsewhere(const Facts& facts, Found& found) {
  for (const auto& [post, count] : facts.reports_elsewhere) {
    found.push_back({.id = "reports_elsewhere:" + post,
                     .severity = Severity::Ask,
                     .side = Side::Box,
                     .subject = post,
                     .headline = {count == 1 ? "1 report" : sentence(count, " reports"), "for another server",
                                  count != 1},
                     .why = sentence("queued for ", post, ", which the settings do not name"),
                     .action = {"Open set-up", "/setup"},
                     .degree = count});
  }
}

}  // namespace

void find_report_troubles(const Facts& facts, Found& found) {
  find_undecided(facts, found);
  find_few_left(facts, found);
  find_elsewhere(facts, found);
  if (!facts.run_unreliable.empty()) {
    found.push_back({.id = "run_unreliable",
                     .severity = Severity::Ask,
                     .side = Side::CommandPost,
                     .headline = {"The count of reports", "uncertain"},
                     .why = facts.run_unreliable});
  }
  if (!facts.run_renamed.empty()) {
    found.push_back({.id = "run_renamed",
                     .severity = Severity::Ask,
                     .side = Side::CommandPost,
                     .headline = {"The name of the run", "uncertain"},
                     .why = facts.run_renamed});
  }
  if (facts.messages_rejected > 0) {
    const bool one = facts.messages_rejected == 1;
    found.push_back(
        {.id = "messages_rejected",
         .severity = Severity::Ask,
         .side = Side::CommandPost,
         .headline = {sentence(facts.messages_rejected, one ? " message" : " messages"), "rejected", !one},
         .why = sentence("the Command Post did not accept ",
                         one ? "it: " : "them; the newest: ", facts.newest_rejected_why),
         .action = {"Show", "/#rejected"},
         .degree = facts.newest_rejected});  // rises even if an older message made room
  }
}

}  // namespace adit::alarms
