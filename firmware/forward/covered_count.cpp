#include "forward/covered_count.hpp"

#include <optional>
#include <utility>

#include "icd/refuse.hpp"

namespace adit::forward {

struct CoveredCount::Job {
  std::vector<Done> askers;
  picture::CoveredArea::Changes changes;
  std::optional<picture::Covered> covered{};
};

void CoveredCount::covered(Done done) {
  if (askers_.size() == kMostAskers)
    return done(
        icd::refuse(icd::Status::ServiceUnavailable, "too many requests for the area; try again later"));
  askers_.push_back(std::move(done));
  if (!is_counting_) pump();
}

/// Later requests wait for the next count, because the map may change.
void CoveredCount::pump() {
  if (askers_.empty()) return;
  is_counting_ = true;
  const auto job =
      std::make_shared<Job>(Job{.askers = std::exchange(askers_, {}), .changes = area_->changes(mosaic_)});
  workers_.submit(
      loop::Urgency::CanWait,
      [job, area = area_, &workers = workers_] {  // workers outlive the jobs
        area->update(job->changes, [&workers] { workers.give_way(); });
        job->covered = area->now();
        job->changes.places.clear();
      },
      [this, job] { counted(*job); });
}

void CoveredCount::counted(const Job& job) {
  is_counting_ = false;
  for (const Done& done : job.askers) {
    if (job.covered) {
      done(*job.covered);
    } else {
      done(icd::refuse(icd::Status::ServiceUnavailable, "no memory"));
    }
  }
  if (!is_counting_) pump();
}

}  // namespace adit::forward
