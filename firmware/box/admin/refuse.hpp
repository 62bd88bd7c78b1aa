#pragma once

#include <expected>
#include <string>
#include <utility>

#include "icd/status.hpp"

namespace adit::admin {

inline std::unexpected<icd::Refusal> refuse(icd::Status status, std::string sentence) {
  return std::unexpected(icd::Refusal{status, std::move(sentence)});
}

/// The box's state forbids it now.
inline std::unexpected<icd::Refusal> conflict(std::string sentence) {
  return refuse(icd::Status::Conflict, std::move(sentence));
}

}  // namespace adit::admin
