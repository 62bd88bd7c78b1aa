#pragma once

#include <cmath>
#include <optional>
#include <string_view>

#include "api/number_in.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// A number of the query: absent, or a finite one, or no number at all.
struct AskedNumber {
  std::optional<double> number;
  bool wrong = false;
};

inline AskedNumber asked_number(const intake::RequestHead& head, std::string_view name) {
  const std::string_view text = head.query(name);
  if (text.empty()) return {};
  const auto number = number_in<double>(text);
  if (!number || !std::isfinite(*number)) return {.number = {}, .wrong = true};
  return {.number = number};
}

}  // namespace adit::api
