#pragma once

#include <utility>

#include "codec/read.hpp"
#include "intake/visit.hpp"

namespace adit::intake {

/// Gives the accepted parts of a state or of markers to the desk. If the desk accepts them, the answer is
/// about the rejected parts.
template <class Message>
void take_parts(const Visit& visit, icd::Checked<codec::CheckedParts<Message>> read) {
  if (!read) return visit.refuse(read.error());
  auto taken = visit.desk.take(std::move(read->message), visit.sender_at_end());
  if (taken && read->refused.count > 0) taken = std::unexpected(read->refused.refusal());
  visit.answer(taken);
}

}  // namespace adit::intake
