#pragma once

#include <cmath>
#include <optional>
#include <string_view>

#include "icd/text.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// A number in the query. `wrong`: present but not a finite number.
struct AskedNumber {
  std::optional<double> number;
  bool wrong = false;
};

inline AskedNumber asked_number(const intake::RequestHead& head, std::string_view name) {
  const std::string_view text = head.query(name);
  if (text.empty()) return {};
  const auto number = icd::number_in<double>(text);
  if (!number || !std::isfinite(*number)) return {.number = {}, .wrong = true};
  return {.number = number};
}

}  // namespace adit::api
