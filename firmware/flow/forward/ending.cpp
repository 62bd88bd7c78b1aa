#include "forward/ending.hpp"

#include "icd/require.hpp"

namespace adit::forward {

bool Ending::dismisses(loop::Instant now, bool quiet, bool kept) {
  icd::require(has_begun());
  const loop::Instant answers_by = *began_ + kAnswers;
  const bool may_end = kept || now >= answers_by + kKeepWithin;
  dismissed_ = may_end && (quiet || now >= answers_by);
  return dismissed_;
}

bool Ending::is_over(loop::Instant now) const {
  icd::require(has_begun());
  return dismissed_ || now >= *began_ + kAnswers + 2 * kKeepWithin;
}

}  // namespace adit::forward
