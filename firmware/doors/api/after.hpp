#pragma once

#include "api/answers.hpp"
#include "api/clock.hpp"
#include "api/network.hpp"
#include "api/self_test.hpp"
#include "api/spare.hpp"
#include "api/updates.hpp"

namespace adit::api {

/// The present state of a part of the gateway.
inline intake::Answer shown(const Clock& clock) {
  return fresh(clock.clock());
}
inline intake::Answer shown(const Network& network) {
  return fresh(network.network());
}
inline intake::Answer shown(const SelfTest& test) {
  return fresh(test.test());
}
inline intake::Answer shown(const Spare& spare) {
  return fresh(spare.spare());
}
inline intake::Answer shown(const Updates& updates) {
  return fresh(updates.update());
}

/// The answer to an action: the part's state, or the refusal.
template <class Part>
intake::Answer after(const Part& part, const icd::Checked<void>& done) {
  return done ? shown(part) : refused(done.error());
}

}  // namespace adit::api
