#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "rehearsal/command_post/document.hpp"

namespace adit::rehearsal {

struct Artifact {
  std::string type;
  Vector3 position;
  bool claimed = false;  // by a report that scored
};

/// A CSV of true artifacts: a header "type,x,y,z", then one a line, in metres. An error names the line.
std::expected<std::vector<Artifact>, std::string> read_artifacts(const std::string& path);

using Clock = std::chrono::steady_clock;

/// What the public test server's clocks always show, whatever the time: /api/status and answers to reports.
inline constexpr double kMeasuredStatusClock = 25.98;
inline constexpr double kMeasuredReportClock = 3.14;

struct RunPlan {
  std::string team = "adit";
  std::string id = "1";
  bool renames = true;  // a new run has another id by itself
  std::chrono::duration<double> length{3600};
  std::int64_t reports = 45;  // the allotment
};

/// The changes of a new run. Values that are not given stay. An id counts up if the plan says so.
struct NewRun {
  std::optional<std::string> id;
  std::optional<std::string> team;
  bool started = true;
};

/// The run, and those after it: the clock, the score and what becomes of each report (ICD 5). Reports are
/// numbered through all of them. Safe for use by several threads.
class Run {
 public:
  struct Standing {
    std::string team;
    std::string run;    // its id
    std::string state;  // "not started", "running", "admin stop", "ended"
    double clock = 0;   // seconds since the start; goes on after the end
    std::int64_t score = 0;
    std::int64_t remaining_reports = 0;
  };

  struct Ruling {
    std::int64_t id = 0;
    std::string team;
    std::string run;
    double clock = 0;
    std::string status;  // report_status, one of ICD 5.2's
    std::int64_t score_change = 0;
    std::int64_t repeats = 0;  // the id of the same report that was scored before in this run; 0: none
  };

  Run(RunPlan plan, std::vector<Artifact> artifacts)
      : plan_(std::move(plan)), artifacts_(std::move(artifacts)) {}

  enum class Change { Start, Stop, Resume, End };  // Stop: an admin stop

  /// False if the run's state does not allow it.
  bool change(Change change, Clock::time_point now);

  /// Whatever became of the last run: the clock and the score at 0, no report used, no artifact found.
  void restart(const NewRun& wanted, Clock::time_point now);

  /// Gives the run the next name; it goes on. Returns the name.
  std::string rename();
  /// One more report is allowed in this run. Returns remaining_reports.
  std::int64_t grant();

  Standing standing(Clock::time_point now) const;

  /// Rules on a report, and uses one of the allotment if it is scored. Without a position (the measured
  /// server accepts coordinates that are no numbers) it scores nothing.
  Ruling submit(const std::string& type, const std::optional<Vector3>& position, Clock::time_point now);

 private:
  enum class State { NotStarted, Running, AdminStop, Ended };
  State state_at(Clock::time_point now) const;
  double clock_at(Clock::time_point now) const;

  mutable std::mutex mutex_;
  RunPlan plan_;
  std::vector<Artifact> artifacts_;
  std::optional<Clock::time_point> started_;
  bool stopped_ = false;
  bool ended_ = false;
  std::int64_t score_ = 0;
  std::int64_t used_ = 0;
  std::int64_t granted_ = 0;
  /// Ids of scored reports by type, in lower case, and place.
  std::map<std::tuple<std::string, double, double, double>, std::int64_t> scored_;
  std::int64_t last_id_ = 0;
};

}  // namespace adit::rehearsal
