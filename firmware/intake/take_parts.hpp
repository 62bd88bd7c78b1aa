#pragma once

#include <utility>

#include "codec/read.hpp"
#include "intake/visit.hpp"

namespace adit::intake {

/// Gives the good parts of a state or of markers to the desk. If they are taken, the answer is about the
/// others.
template <class Message>
void take_parts(const Visit& visit, icd::Checked<codec::InParts<Message>> read) {
  if (!read) return visit.refuse(read.error());
  auto taken = visit.desk.take(std::move(read->message), visit.sender);
  if (taken && read->refused.count > 0) taken = std::unexpected(read->refused.refusal());
  visit.answer(taken);
}

}  // namespace adit::intake
