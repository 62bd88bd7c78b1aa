#pragma once

#include <cstdint>
#include <vector>

#include "dispatch/reports.hpp"

namespace adit::dispatch::model {

/// In simulated time.
using Seconds = double;

struct Recorded {
  double key = 0;  // x of the report, which identifies it; negative: another sender's
  std::int64_t run = 0;
  bool scored = false;
  std::int64_t points = 0;
  Seconds run_began = 0, at = 0;
};

/// As in section 5 of the ICD: records each report, scores it if the run goes on and reports are left, and
/// does not recognise a repeat.
class CommandPost {
 public:
  enum class Phase { NotStarted, Running, AdminStop };
  /// Running: both URIs show one clock. Differing: each URI has its own clock. Standing: as at the public
  /// test server, each URI shows a constant, and each run is called "1".
  enum class Clocks { Running, Differing, Standing };

  explicit CommandPost(Clocks clocks = Clocks::Running, bool one_name = false)
      : clocks_(clocks), one_name_(one_name || clocks == Clocks::Standing) {}

  HttpAnswer record(const icd::ArtifactReport& report, Seconds now);
  icd::RunStatus status(Seconds now) const;
  void other_sender(Seconds now) { record({"rope", {-1, 0, 0}}, now); }
  void new_run(Seconds now);
  void set(Phase phase) { phase_ = phase; }

  Seconds run_began() const { return started_; }
  std::int64_t run() const { return run_; }
  const std::vector<Recorded>& recorded() const { return recorded_; }

 private:
  const Clocks clocks_;
  const bool one_name_;
  Phase phase_ = Phase::Running;
  std::int64_t run_ = 1;
  Seconds started_ = 0;
  std::int64_t remaining_ = 25, score_ = 0;
  std::vector<Recorded> recorded_;
};

}  // namespace adit::dispatch::model
