#include "dispatch/model/command_post.hpp"

#include <algorithm>
#include <cmath>

#include "icd/sentence.hpp"

namespace adit::dispatch::model {
namespace {

/// Every third artifact scores a point.
bool is_good(double key) {
  return std::fmod(std::abs(key), 3) < 1;
}

}  // namespace

HttpAnswer CommandPost::record(const icd::ArtifactReport& report, Seconds now) {
  std::string status = phase_ == Phase::AdminStop    ? "admin stop"
                       : phase_ == Phase::NotStarted ? "run not started"
                       : remaining_ == 0             ? "report limit exceeded"
                                                     : "scored";
  const bool scored = status == "scored";
  const std::int64_t points = scored && is_good(report.position.x) ? 1 : 0;
  if (scored) --remaining_;
  score_ += points;
  recorded_.push_back({report.position.x, run_, scored, points, started_, now});
  const bool stands = clocks_ == Clocks::Standing;
  const double late = clocks_ == Clocks::Differing ? 50 : 0;
  const double clock = stands ? 3.14 : std::max(0.0, now - started_ - late);
  return {201, "application/json",
          icd::sentence("{\"id\": ", recorded_.size(), ", \"run\": \"", one_name_ ? 1 : run_,
                        "\", \"team\": \"adit\", \"run_clock\": ", clock, ", \"report_status\": \"", status,
                        "\", \"score_change\": ", points, "}")};
}

icd::RunStatus CommandPost::status(Seconds now) const {
  return {.score = score_,
          .run_clock = clocks_ == Clocks::Standing   ? 25.98
                       : phase_ == Phase::NotStarted ? 0
                                                     : now - started_,
          .remaining_reports = remaining_,
          .current_team = "adit"};
}

void CommandPost::new_run(Seconds now) {
  ++run_;
  started_ = now;
  remaining_ = 25;
  score_ = 0;
  phase_ = Phase::Running;
}

}  // namespace adit::dispatch::model
