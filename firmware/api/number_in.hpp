#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "intake/server.hpp"

namespace adit::api {

/// The number that `text`, a part of a path or query, consists of; or std::nullopt.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

/// A number in the query. `wrong`: present but not a finite number.
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
