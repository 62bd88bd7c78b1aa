#pragma once

#include <functional>
#include <optional>

#include "rehearsal/command_post/fault.hpp"
#include "rehearsal/command_post/judgement.hpp"

namespace adit::rehearsal {

/// What a request to either endpoint is aimed at by, or nothing. In the measured manner with slashes behind
/// its path, too.
std::optional<Aim> scoring_aim(const Request& request, Manner manner);
std::optional<Aim> mapping_aim(const Request& request);

/// What becomes of a request that the fault keeps from its judge: refused as that manner's endpoint refuses,
/// or cut off. It breaks no rule of the ICD, since nobody looked.
Judgement unjudged(const Fault& fault, Aim aim, const Request& request, Manner manner);

/// Puts the fault between a decided outcome and the connection. An outcome that is no answer stays as it is.
void spoil(const Fault& fault, const Request& request, Judgement& judgement);

/// `then` decides, after `delay`.
Outcome later(Fault::Seconds delay, std::function<Outcome()> then);

}  // namespace adit::rehearsal
