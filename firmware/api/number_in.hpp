#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace adit::api {

/// The number that all of `text`, a part of a path or of a query, is; or nothing.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

}  // namespace adit::api
