#pragma once

#include <expected>

#include "icd/sentence.hpp"
#include "icd/status.hpp"

namespace adit::icd {

/// A refusal with that status and sentence.
template <class... Parts>
std::unexpected<Refusal> refuse(Status status, const Parts&... parts) {
  return std::unexpected(Refusal{status, sentence(parts...)});
}

}  // namespace adit::icd
