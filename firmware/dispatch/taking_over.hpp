#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "dispatch/report.hpp"
#include "dispatch/run.hpp"
#include "icd/run_status.hpp"

namespace adit::dispatch {

/// All that a box knows of reports and runs.
struct Books {
  std::vector<Report> reports;
  std::vector<Run> runs;
};

/// A report as the spare is to know it.
struct TakenOver {
  Report report;
  std::int64_t there = 0;   // its number at the first box, where it is new here; 0: it was known here
  bool has_stepped = true;  // it is not as it was where it comes from: its life has one step more
};

/// What a spare writes down that takes over, all of it as one.
struct TakeOver {
  std::vector<TakenOver> reports;
  std::vector<Run> runs;
};

/// How the first box came to rest.
struct Handover {
  /// What /api/status would have answered; nothing: that is not known for certain.
  std::optional<icd::RunStatus> expected = std::nullopt;
  double stamp = 0;  // now, at the spare; seconds since 1970
  double ahead = 0;  // so many seconds the spare's clock for stamps is ahead of the first box's
};

/// What the spare (`here`) knows once it takes over from the first box (`there`). README.md has the rules.
/// Done twice, the second time changes nothing.
TakeOver take_over(const Books& here, const Books& there, const Handover& handover);

}  // namespace adit::dispatch
