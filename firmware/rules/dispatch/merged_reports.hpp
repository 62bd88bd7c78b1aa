#pragma once

#include <cstdint>
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
struct TakeoverChanges {
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
TakeoverChanges take_over(const Books& here, const Books& there, const Handover& handover);

}  // namespace adit::dispatch
