#pragma once

#include <algorithm>
#include <expected>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "api/source.hpp"

namespace adit::api {

/// The rows of `all` numbered above `after`, oldest first, as a Source returns them.
inline std::vector<facts::ReportRow> rows_after(std::vector<facts::ReportRow> all, std::int64_t after,
                                                std::size_t most) {
  std::erase_if(all, [after](const facts::ReportRow& row) { return row.number <= after; });
  all.resize(std::min(all.size(), most));
  return all;
}

inline ReportCounts counts_of(const std::vector<facts::ReportRow>& rows) {
  ReportCounts counts;
  for (const facts::ReportRow& row : rows) {
    const auto state = dispatch::state_named(row.state);
    if (state) ++counts.in.at(static_cast<std::size_t>(*state));
    counts.asking += row.asking ? 1 : 0;
  }
  return counts;
}

/// Records operations on a scene's reports, so that a browser sees their effect.
class Played {
 public:
  std::expected<std::int64_t, std::string> decide(const RunView& view, std::int64_t number, Action action) {
    const auto found = std::ranges::find(view.reports, number, &facts::ReportRow::number);
    if (found == view.reports.end()) return std::unexpected("there is no such report");
    if (found->state == "rejected") return std::unexpected("the step could not be written down; try again");
    if (action == Action::Resubmit) return add(view, found->type, found->position.value_or(icd::Point{}));
    states_[number] = action == Action::Send       ? "queued"
                      : action == Action::Hold     ? "held"
                      : action == Action::Withdraw ? "withdrawn"
                                                   : "settled";
    return number;
  }

  std::expected<std::int64_t, std::string> report(const RunView& view, const icd::ArtifactReport& report,
                                                  bool resubmit) {
    if (report.position.x == 666)
      return std::unexpected("1000 reports are queued already; this report was not accepted");
    for (const facts::ReportRow& row : view.reports) {
      if (row.type == report.type && row.position == report.position && !resubmit) return row.number;
    }
    return add(view, report.type, report.position);
  }

  std::expected<std::int64_t, std::string> correct(const RunView& view, std::int64_t number,
                                                   const icd::ArtifactReport& to) {
    states_[number] = "withdrawn";
    return add(view, to.type, to.position);
  }

  std::expected<void, std::string> rejected(const RunView& view, std::uint64_t number) {
    const auto found = std::ranges::find(view.rejected, number, &facts::RejectedRow::number);
    if (found == view.rejected.end()) return std::unexpected("nothing of that number is rejected");
    decided_messages_.insert(number);
    return {};
  }

  std::int64_t begin_run(const RunView& view) {
    for (const facts::ReportRow& row : view.reports) {
      if (row.state == "queued") states_[row.number] = "held";
    }
    ++runs_;
    return view.run_number + 1;
  }

  std::expected<void, std::string> acknowledge(const RunView& view, const std::string& id) {
    if (std::ranges::find(view.alarms, id, &alarms::Alarm::id) == view.alarms.end())
      return std::unexpected("there is no such alarm any more");
    acknowledged_.insert(id);
    return {};
  }

  void apply(RunView& view) const {
    for (alarms::Alarm& alarm : view.alarms) alarm.acknowledged |= acknowledged_.contains(alarm.id);
    view.run_number += runs_;
    std::erase_if(view.rejected,
                  [this](const facts::RejectedRow& row) { return decided_messages_.contains(row.number); });
    for (facts::ReportRow& row : view.reports) {
      if (const auto state = states_.find(row.number); state != states_.end()) {
        row.state = state->second;
        row.changed = view.now;
      }
    }
    for (const facts::ReportRow& row : added_) view.reports.insert(view.reports.begin(), row);
  }

 private:
  std::int64_t add(const RunView& view, const std::string& type, const icd::Point& position) {
    facts::ReportRow row;
    row.number = (view.reports.empty() ? 0 : view.reports.front().number) + 1;
    row.type = type;
    row.position = position;
    row.sender = "operator";
    row.received = row.changed = view.now;
    row.state = "queued";
    row.run = view.run_number;
    added_.push_back(row);
    return row.number;
  }

  std::set<std::uint64_t> decided_messages_;
  std::set<std::string> acknowledged_;
  std::map<std::int64_t, std::string> states_;
  std::int64_t runs_ = 0;                // declared by the operator
  std::vector<facts::ReportRow> added_;  // oldest first
};

}  // namespace adit::api
