#include "gateway/known_status.hpp"

#include <utility>

#include "codec/write.hpp"

namespace adit::gateway {

void KnownStatus::heard(std::string body, loop::Instant now) {
  body_ = std::move(body);
  heard_ = now;
  fresh_ = true;
}

bool KnownStatus::is_fresh(loop::Instant now) const {
  return fresh_ && heard_ && now - *heard_ < kFresh;
}

std::optional<intake::Answer> KnownStatus::answer(loop::Instant now) const {
  if (!heard_ || now - *heard_ > kOldest) return std::nullopt;
  const auto age = std::chrono::floor<std::chrono::seconds>(now - *heard_).count();
  return intake::Answer{.status = icd::Status::Ok,
                        .content_type = std::string(codec::kJson),
                        .body = body_,
                        .headers = {{"Age", std::to_string(age)}}};
}

}  // namespace adit::gateway
