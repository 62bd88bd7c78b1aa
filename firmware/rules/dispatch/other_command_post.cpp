#include "dispatch/other_command_post.hpp"

#include <algorithm>

#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

/// Unfinished reports at the Command Post that the settings name.
struct Open {
  std::size_t waiting = 0, in_doubt = 0, held = 0;
  std::size_t all() const { return waiting + in_doubt + held; }
};

Open open_here(const Reports& reports) {
  Open open;
  for (const std::int64_t number : reports.book().open()) {
    const Report& report = reports.book().at(number);
    if (!reports.runs().is_at(report.run, reports.meant_run().post)) continue;
    open.waiting += report.state == ReportState::Queued ? 1 : 0;
    open.held += report.state == ReportState::Held ? 1 : 0;
    // A report in flight may still come into doubt.
    const bool unclear = report.state == ReportState::InDoubt || report.state == ReportState::Sending;
    open.in_doubt += unclear ? 1 : 0;
  }
  return open;
}

/// "2 reports are queued, 1 is in doubt"
std::string counted(const Open& open) {
  std::string text;
  const auto add = [&text](std::size_t count, const char* one, const char* many) {
    if (count == 0) return;
    const char* const what = text.empty() ? (count == 1 ? " report " : " reports ") : " ";
    text += icd::sentence(text.empty() ? "" : ", ", count, what, count == 1 ? one : many);
  };
  add(open.waiting, "is queued", "are queued");
  add(open.in_doubt, "is in doubt", "are in doubt");
  add(open.held, "is held", "are held");
  return text;
}

std::string what_is_known_at(const Reports& reports, const std::string& post) {
  const Run* const known = reports.runs().at_post(post);
  if (known == nullptr) return "";
  const auto count = std::ranges::count_if(
      reports.book().all(), [known](const auto& item) { return item.second.run == known->number; });
  return icd::sentence("; run ", known->number, " there continues, with ", count,
                       count == 1 ? " report" : " reports");
}

}  // namespace

std::string meaning_of_other_command_post(const Reports& reports, const std::string& post) {
  const std::string& here = reports.meant_run().post;
  std::string text = "reports go to " + post + " from then on" + what_is_known_at(reports, post);
  const Open open = open_here(reports);
  if (open.all() == 0) return text + "; no report is queued, in doubt or held now";
  text += "; " + counted(open);
  if (!reports.meant_run().was_heard()) {
    return text + ": the Command Post at " + here +
           " has not answered yet, so queued reports are sent to the first Command Post that answers";
  }
  const char* const kept =
      open.all() == 1 ? ": Adit keeps it for the run at " : ": Adit keeps them for the run at ";
  return text + kept + here + ", and sends them to the new Command Post only on request";
}

}  // namespace adit::dispatch
