#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dispatch/output.hpp"
#include "dispatch/report.hpp"

namespace adit::dispatch {

/// All reports in memory. Output writes each step to disk before the step has effects.
class ReportBook {
 public:
  /// Changes other fields than the state.
  using Edit = std::function<void(Report&)>;

  struct Step {
    std::int64_t number = 0;
    ReportEvent event = ReportEvent::Held;
    std::string note = "";
    Edit edit = nullptr;
  };

  /// Carries out the action of a step that move() has taken.
  using Follow = std::function<void(std::int64_t number, ReportAction action, Time time)>;

  /// `output` outlives this.
  explicit ReportBook(Output& output, Follow follow = nullptr)
      : output_(output), follow_(std::move(follow)) {}

  void open(std::vector<Report> all) {
    for (Report& report : all) put(std::move(report));
  }
  /// Takes all reports and the unwritten steps.
  void adopt(const ReportBook& before);

  std::int64_t next_number() const { return reports_.empty() ? 1 : reports_.rbegin()->first + 1; }
  /// Adds a queued report and applies `events`, in one write, after the steps `before`. `edit` runs after
  /// each event. Returns the number; 0: the write failed, and no report was added or changed.
  std::int64_t add(Report report, std::span<const ReportEvent> events, const std::string& note,
                   const Edit& edit = nullptr, std::span<const Report> before = {});

  /// Applies steps of different reports in one write and follows their actions. False: no step was applied:
  /// the table lacks one or the write failed. With an act of the Command Post or the network, all are applied
  /// even if the write fails, and written later. Until then the ledger has "sending": a restart is in doubt.
  bool move(std::span<const Step> steps, Time time);
  bool move(const Step& step, Time time) { return move({&step, 1}, time); }
  /// Changes reports but not their states, in one write. False: the write failed, no report changed.
  bool note(std::span<const Report> noted) { return noted.empty() || write(noted, false); }
  /// Writes the run and its reports in one write. A failed write is repeated later.
  void change(std::span<const Report> steps, const Run& run);
  void write(const Run& run) { change({}, run); }
  /// Retries failed writes. True: all is on disk.
  bool catch_up() { return (unwritten_.empty() && unwritten_runs_.empty()) || write({}, false); }

  const Report& at(std::int64_t number) const { return reports_.at(number); }
  const Report* find(std::int64_t number) const;
  const std::map<std::int64_t, Report>& all() const { return reports_; }
  /// Same reports (report.hpp) in all runs, oldest first.
  std::vector<const Report*> find_same(const icd::ArtifactReport& report) const;
  /// The report in flight, or null.
  const Report* sending() const { return sending_.empty() ? nullptr : &at(*sending_.begin()); }
  /// Queued, oldest first.
  const std::set<std::int64_t>& waiting() const { return waiting_; }
  /// Unfinished, oldest first.
  const std::set<std::int64_t>& open() const { return open_; }
  std::size_t count(ReportState state) const { return counts_.at(static_cast<std::size_t>(state)); }
  /// In doubt, oldest first.
  const std::set<std::int64_t>& numbers_in_doubt() const { return in_doubt_; }
  /// In doubt in `run`, in the order of sending.
  std::vector<const Report*> doubts(std::int64_t run) const;

 private:
  bool write(std::span<const Report> steps, bool happened, Flush flush = Flush::Now);
  bool write_earlier_runs();
  void put(Report report);

  Output& output_;
  Follow follow_;
  std::map<std::int64_t, Report> reports_;
  std::multimap<double, std::int64_t> by_x_;  // report numbers
  std::array<std::size_t, std::size(kStateWords)> counts_{};
  std::set<std::int64_t> sending_;
  std::set<std::int64_t> waiting_;
  std::set<std::int64_t> open_;
  std::set<std::int64_t> in_doubt_;
  std::set<std::int64_t> unwritten_;  // last step not on disk
  std::vector<Run> unwritten_runs_;   // last changed run at the end
};

}  // namespace adit::dispatch
