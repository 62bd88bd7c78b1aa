#include "forward/status_cache.hpp"

#include <algorithm>
#include <utility>

#include "codec/json.hpp"
#include "codec/write.hpp"
#include "dispatch/run_watch.hpp"

namespace adit::forward {
namespace {

/// `body` with the figures of `run`. Other members stay.
std::string with_figures(const std::string& body, const icd::RunStatus& run) {
  auto status = codec::parse_json(body);
  auto* const members = status ? std::get_if<codec::Value::Object>(&status->is) : nullptr;
  if (members == nullptr) return body;
  const bool has_run_clock =
      std::ranges::find(*members, "run_clock", &codec::Value::Member::first) != members->end();
  for (auto& [name, value] : *members) {
    if (name == "score") value.is = run.score;
    if (name == "remaining_reports") value.is = run.remaining_reports;
    if (name == (has_run_clock ? "run_clock" : "clock")) value.is = run.run_clock;
  }
  return codec::write_json(*status);
}

}  // namespace

void StatusCache::heard(std::string body, const icd::RunStatus& run, loop::Instant asked, icd::Stamp now) {
  body_ = std::move(body);
  run_ = corrected_ = run;
  run_clock_.heard(run.run_clock, now);
  asked_ = asked;
  fresh_ = true;
}

void StatusCache::add_report(const dispatch::Effect& effect, double run_clock, loop::Instant now) {
  if (!corrected_) return;
  if (effect.scored) {
    corrected_->remaining_reports -= 1;
    corrected_->score += effect.points.value_or(0);
  }
  const double passed = std::chrono::duration<double>(now - *asked_).count();
  const bool may_be_its_clock = run_clock - run_->run_clock <= passed + dispatch::kClockJitter;
  if (may_be_its_clock) corrected_->run_clock = std::max(corrected_->run_clock, run_clock);
  body_ = with_figures(body_, *corrected_);
}

bool StatusCache::is_fresh(loop::Instant now) const {
  return fresh_ && asked_ && now - *asked_ < kFresh;
}

std::optional<intake::Answer> StatusCache::answer(loop::Instant now) const {
  if (!asked_ || now - *asked_ > kOldest) return std::nullopt;
  const auto age = std::chrono::floor<std::chrono::seconds>(now - *asked_).count();
  return intake::Answer{.status = icd::Status::Ok,
                        .content_type = std::string(codec::kJson),
                        .body = body_,
                        .headers = {{"Age", std::to_string(age)}}};
}

}  // namespace adit::forward
