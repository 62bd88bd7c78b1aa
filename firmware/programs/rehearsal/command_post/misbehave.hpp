#pragma once

#include <span>
#include <string_view>

#include "rehearsal/command_post/fault.hpp"
#include "rehearsal/command_post/gate.hpp"

namespace adit::rehearsal {

/// A request whose answer is to be spoiled.
struct Spoilt {
  Aim aim;
  Manner manner;
  Outcome outcome;  // as it was judged; if it was not, the last good answer to its aim
};

/// A wrong answer to a request (README.md, 'Rehearse with a bad Command Post').
struct Effect {
  std::string_view word;
  bool records;  // the request is judged
  Outcome (*outcome_of)(const Spoilt& spoilt);
};

std::span<const Effect> known_effects();

/// Whether the request is judged at all.
inline bool records(const Fault& fault) {
  return fault.effect == nullptr || fault.effect->records;
}

/// Puts the fault between a decided outcome and the connection. The outcome of a request that was judged
/// stays if it is no answer.
void spoil(const Fault& fault, Aim aim, Manner manner, Judgement& judgement);

}  // namespace adit::rehearsal
