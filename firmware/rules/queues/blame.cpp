#include "queues/blame.hpp"

#include <algorithm>

namespace adit::queues {

Blame::Sender& Blame::sender(const std::string& whose) {
  if (senders_.size() >= kMostSenders && !senders_.contains(whose)) senders_.clear();
  return senders_[whose];
}

void Blame::on_passed(const std::string& whose, Instant now) {
  sender(whose).passes = true;
  last_passed_ = now;
}

Blame::Decision Blame::on_failed(const std::string& whose, Trial& trial, Instant now, bool may_reject) {
  Sender& its = sender(whose);
  if (its.passes && trial.failures == 0) its.wavered = now;
  its.passes = false;
  const bool alone = trial.failed && last_passed_ && *last_passed_ > *trial.failed &&
                     !has_other_wavered(whose, *trial.failed);
  ++trial.failures;
  if (alone) ++trial.strikes;
  if (alone && may_reject) ++trial.proofs;
  trial.failed = now;
  trial.steps_behind = true;
  trial.rests_until = trial.strikes == 0
                          ? now
                          : now + std::min(kFirstRest * (1 << std::min(trial.strikes - 1, 8)), kLongestRest);
  return trial.proofs >= kMostStrikes ? Decision::Reject : Decision::Retry;
}

bool Blame::has_other_wavered(const std::string& but, Instant since) const {
  return std::ranges::any_of(senders_, [&](const auto& item) {
    return item.first != but && item.second.wavered && *item.second.wavered > since;
  });
}

}  // namespace adit::queues
