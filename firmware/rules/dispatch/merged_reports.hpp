#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "dispatch/report.hpp"
#include "dispatch/runs.hpp"
#include "icd/scoring.hpp"

namespace adit::dispatch {

struct Books {
  std::vector<Report> reports;
  std::vector<Run> runs;
};

struct TakenOverReport {
  Report report;
  std::int64_t there = 0;   // number at the first box; 0: known here
  bool has_stepped = true;  // it differs from its source, so its history has one more step
};

/// The changes that a spare writes in one transaction when it takes over.
struct TakeOver {
  std::vector<TakenOverReport> reports;
  std::vector<Run> runs;
};

/// The first box's state at its stop.
struct Handover {
  /// nullopt: uncertain.
  std::optional<icd::RunStatus> expected = std::nullopt;
  double stamp = 0;  // now, at the spare; seconds since 1970
  double ahead = 0;  // the spare's stamps less the first box's, seconds
};

/// Merges the first box (`there`) into the spare (`here`) by README.md. A repetition has no effect.
TakeOver take_over(const Books& here, const Books& there, const Handover& handover);

/// Reports of the first box that the spare has, and the spare's.
using SameReports = std::map<const Report*, const Report*>;

/// The runs of a takeover: the first box's (`there`) with their numbers at the spare (`here`).
class MergedRuns {
 public:
  /// `same`: of the reports of `here` and `there`. `ahead`: Handover::ahead, seconds. `here` and `same` must
  /// outlive this object.
  MergedRuns(const Books& here, const Books& there, const SameReports& same, double ahead);

  /// The first box's runs by their numbers here, merged with those that the spare knew.
  const std::map<std::int64_t, Run>& all() const { return merged_; }
  /// The number here; `there` if the first box has no such run.
  std::int64_t number_here(std::int64_t there) const;
  bool is_present_there(std::int64_t there) const { return there_runs_.present().number == there; }

  /// The number here of the first box's present run.
  std::int64_t present() const { return numbers_.at(there_runs_.present().number); }
  /// The spare's last run at the same Command Post that the first box does not know; 0: none.
  std::int64_t own() const { return own_; }
  /// True if own() is certainly not present().
  bool own_is_another() const { return own_is_another_; }
  /// True if `here` is a run of the spare that was never heard and that the first box does not know.
  bool is_unheard(std::int64_t here) const;

 private:
  bool is_blank() const;
  std::int64_t run_known_as(const Run& run) const;
  void take(const Run& run, std::int64_t turn);
  const Run* own_run() const;
  bool has_reports(std::int64_t run) const;
  void link_to_own();

  const Books& here_;
  const SameReports& same_;
  const double ahead_;
  const Runs here_runs_, there_runs_;
  std::map<std::int64_t, std::int64_t> numbers_;  // from numbers there to numbers here
  std::map<std::int64_t, bool> is_new_;           // by the number there
  std::map<std::int64_t, Run> merged_;            // by the number here
  std::int64_t own_ = 0;
  bool own_is_another_ = false;
};

}  // namespace adit::dispatch
