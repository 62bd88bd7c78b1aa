#include "forward/ending.hpp"

namespace adit::forward {

bool Ending::dismisses(loop::Instant now, bool quiet, bool kept) {
  const loop::Instant answers_by = *began_ + kAnswers;
  const bool may_end = kept || now >= answers_by + kKeepWithin;
  dismissed_ = may_end && (quiet || now >= answers_by);
  return dismissed_;
}

}  // namespace adit::forward
