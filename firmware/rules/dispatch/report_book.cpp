#include "dispatch/report_book.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "dispatch/report.hpp"

namespace adit::dispatch {
namespace {

/// The Command Post or the network acted, so a failed write cannot undo it. A restart has the state already.
bool is_irreversible(ReportEvent event) {
  using enum ReportEvent;
  constexpr ReportEvent kHappened[] = {Recorded,   Rejected,  Throttled, Barred,
                                       Redirected, NeverLeft, Lost,      Restarted};
  return std::ranges::find(kHappened, event) != std::end(kHappened);
}

/// After a power cut the run's status would show it.
bool can_recover_from_status(const Report& report, ReportEvent event) {
  const bool is_answer = event == ReportEvent::Recorded || event == ReportEvent::Rejected;
  return is_answer && report.before.has_value();
}

}  // namespace

void ReportBook::adopt(const ReportBook& before) {
  for (const auto& [number, report] : before.reports_) put(report);
  unwritten_ = before.unwritten_;
  unwritten_runs_ = before.unwritten_runs_;
}

std::int64_t ReportBook::add(Report report, std::span<const ReportEvent> events, const std::string& note,
                             const Edit& edit, std::span<const Report> before) {
  report.number = next_number();
  report.state = ReportState::Queued;
  std::vector<Report> steps(before.begin(), before.end());
  steps.push_back(report);
  for (const ReportEvent event : events) {
    report.state = transition(report.state, event)->to;
    report.note = note;
    if (edit) edit(report);
    steps.push_back(report);
  }
  return write(steps, false) ? report.number : 0;
}

bool ReportBook::move(std::span<const Step> steps, Time time) {
  if (steps.empty()) return true;
  std::vector<Report> moved;
  std::vector<ReportAction> actions;
  bool happened = false;
  bool soon = true;
  for (const Step& step : steps) {
    Report& report = moved.emplace_back(reports_.at(step.number));
    const ReportTransition* const row = transition(report.state, step.event);
    if (row == nullptr) return false;
    actions.push_back(row->action);
    report.state = row->to;
    report.note = step.note;
    report.changed = time.stamp;
    if (step.edit) step.edit(report);
    happened = happened || is_irreversible(step.event);
    soon = soon && can_recover_from_status(report, step.event);
  }
  if (!write(moved, happened, soon ? Flush::Soon : Flush::Now)) return false;
  for (std::size_t i = 0; follow_ && i < moved.size(); ++i) follow_(moved[i].number, actions[i], time);
  return true;
}

void ReportBook::change(std::span<const Report> steps, const Run& run) {
  std::erase_if(unwritten_runs_, [&](const Run& other) { return other.number == run.number; });
  unwritten_runs_.push_back(run);
  write(steps, true);
}

/// The last changed run is written with its reports.
bool ReportBook::write_earlier_runs() {
  while (unwritten_runs_.size() > 1) {
    if (!output_.write({}, &unwritten_runs_.front(), Flush::Now)) return false;
    unwritten_runs_.erase(unwritten_runs_.begin());
  }
  return true;
}

/// Writes failed steps first, so that the ledger has no gaps.
bool ReportBook::write(std::span<const Report> steps, bool happened, Flush flush) {
  bool written = write_earlier_runs();
  const Run* const run = unwritten_runs_.empty() ? nullptr : &unwritten_runs_.back();
  if (!written) {
    // The write failed.
  } else if (unwritten_.empty()) {
    written = output_.write(steps, run, flush);
  } else {
    std::vector<Report> all;
    all.reserve(unwritten_.size() + steps.size());
    for (const std::int64_t number : unwritten_) all.push_back(reports_.at(number));
    all.insert(all.end(), steps.begin(), steps.end());
    written = output_.write(all, run, Flush::Now);
  }
  if (written) {
    unwritten_.clear();
    unwritten_runs_.clear();
  }
  if (!written && !happened) return false;
  for (const Report& report : steps) {
    put(report);
    if (!written) unwritten_.insert(report.number);
  }
  return true;
}

std::vector<const Report*> ReportBook::find_same(const icd::ArtifactReport& report) const {
  std::vector<const Report*> same;
  const double x = report.position.x;
  const auto end = by_x_.upper_bound(x + 2 * kSamePlace);
  for (auto each = by_x_.lower_bound(x - 2 * kSamePlace); each != end; ++each) {
    if (const Report& other = reports_.at(each->second); is_same(other.report, report))
      same.push_back(&other);
  }
  std::ranges::sort(same, {}, &Report::number);
  return same;
}

void ReportBook::put(Report report) {
  const std::int64_t number = report.number;
  const ReportState state = report.state;
  if (const Report* const before = find(number); before != nullptr) {
    --counts_.at(static_cast<std::size_t>(before->state));
  } else {
    by_x_.emplace(report.report.position.x, number);
  }
  ++counts_.at(static_cast<std::size_t>(state));
  const auto keep = [number](std::set<std::int64_t>& numbers, bool is_in) {
    if (is_in) {
      numbers.insert(number);
    } else {
      numbers.erase(number);
    }
  };
  keep(sending_, state == ReportState::Sending);
  keep(waiting_, state == ReportState::Queued);
  keep(in_doubt_, state == ReportState::InDoubt);
  keep(open_, !is_final(state));
  reports_.insert_or_assign(reports_.end(), number, std::move(report));
}

const Report* ReportBook::find(std::int64_t number) const {
  const auto found = reports_.find(number);
  return found == reports_.end() ? nullptr : &found->second;
}

std::vector<const Report*> ReportBook::doubts(std::int64_t run) const {
  std::vector<const Report*> found;
  for (const std::int64_t number : in_doubt_) {
    const Report& report = reports_.at(number);
    if (report.run == run) found.push_back(&report);
  }
  std::ranges::sort(found, {}, &Report::sending);
  return found;
}

}  // namespace adit::dispatch
