#include "forward/status_cache.hpp"

#include <utility>

#include "codec/write.hpp"

namespace adit::forward {

void StatusCache::heard(std::string body, const icd::RunStatus& run, loop::Instant asked, icd::Stamp now) {
  body_ = std::move(body);
  run_ = run;
  run_clock_.heard(run.run_clock, now);
  asked_ = asked;
  fresh_ = true;
}

bool StatusCache::is_fresh(loop::Instant now) const {
  return fresh_ && asked_ && now - *asked_ < kFresh;
}

std::optional<intake::Answer> StatusCache::answer(loop::Instant now, std::chrono::seconds oldest) const {
  if (!asked_ || now - *asked_ > oldest) return std::nullopt;
  const auto age = std::chrono::floor<std::chrono::seconds>(now - *asked_).count();
  return intake::Answer{.status = icd::Status::Ok,
                        .content_type = std::string(codec::kJson),
                        .body = body_,
                        .headers = {{"Age", std::to_string(age)}}};
}

}  // namespace adit::forward
