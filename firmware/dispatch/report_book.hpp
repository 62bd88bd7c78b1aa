#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "dispatch/output.hpp"
#include "dispatch/report.hpp"

namespace adit::dispatch {

/// All reports and the state of each: in memory to be read; Output writes each step to disk before anything
/// follows from it.
class ReportBook {
 public:
  /// What changes beside the state.
  using Edit = std::function<void(Report&)>;

  /// What happens to a report, with a note for the operator.
  struct Step {
    std::int64_t number = 0;
    ReportEvent event = ReportEvent::Held;
    std::string note = "";
    Edit edit = nullptr;
  };

  /// `output` outlives this.
  explicit ReportBook(Output& output) : output_(output) {}

  void open(std::vector<Report> all);

  /// A new report that waits, and the events that happen to it at once, all in one write; `edit` is
  /// done after each of them. Its number; 0: the disk refused, and there is no such report.
  std::int64_t add(Report report, std::span<const ReportEvent> events, const std::string& note,
                   const Edit& edit = nullptr);

  /// Takes the steps that the table has, each of another report, all in one write. A step that the Command
  /// Post made has happened even if the disk refuses: then it is written later, and until then the ledger is
  /// on the safe side ("sending", which a restart reads as in doubt). Other steps are then not taken, none of
  /// them, and it gives false.
  bool move(std::span<const Step> steps, double stamp);
  bool move(const Step& step, double stamp) { return move({&step, 1}, stamp); }
  /// Changes what is known of reports, but not their states, all in one write.
  bool note(std::span<const Report> noted) { return noted.empty() || write(noted, false); }
  /// Writes the run, and all that its change means for the reports, in one write.
  void change(std::span<const Report> steps, const Run& run);
  void write(const Run& run) { change({}, run); }
  /// Tries again to write what could not be written. True: nothing is left.
  bool catch_up();

  const Report& at(std::int64_t number) const { return reports_.at(number); }
  const Report* find(std::int64_t number) const;
  const std::map<std::int64_t, Report>& all() const { return reports_; }
  /// The same report (same_report.hpp), in any run, oldest first.
  std::vector<const Report*> same_as(const icd::ArtifactReport& report) const;
  /// Those in state Queued, oldest first.
  const std::set<std::int64_t>& waiting() const { return waiting_; }
  /// Those with which something is still to happen, oldest first: few of many.
  const std::set<std::int64_t>& open() const { return open_; }
  /// How many are in this state.
  std::size_t count(ReportState state) const { return counts_.at(static_cast<std::size_t>(state)); }
  /// Those in doubt in `run`, in the order in which they were sent.
  std::vector<const Report*> doubts(std::int64_t run) const;

 private:
  bool write(std::span<const Report> steps, bool happened, Flush flush = Flush::Now);
  bool write_earlier_runs();
  void put(Report report);

  Output& output_;
  std::map<std::int64_t, Report> reports_;
  std::multimap<double, std::int64_t> by_x_;  // numbers
  std::array<std::size_t, std::size(kStateWords)> counts_{};
  std::set<std::int64_t> waiting_;
  std::set<std::int64_t> open_;
  std::set<std::int64_t> in_doubt_;
  std::set<std::int64_t> unwritten_;  // their last step has happened, but is not on disk
  std::vector<Run> unwritten_runs_;   // each as it now is, the one that changed last at the end
};

}  // namespace adit::dispatch
