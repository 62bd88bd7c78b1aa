#pragma once

#include <algorithm>
#include <charconv>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace adit::icd {

/// Without these characters at both ends.
constexpr std::string_view trimmed(std::string_view text, std::string_view space = " \t\r\n") {
  text.remove_prefix(std::min(text.find_first_not_of(space), text.size()));
  return text.substr(0, text.find_last_not_of(space) + 1);
}

/// Removes the text before the next `end`, and the `end`, and returns that text. All of it if there is no
/// `end`.
constexpr std::string_view cut(std::string_view& text, char end) {
  const std::string_view piece = text.substr(0, text.find(end));
  text.remove_prefix(std::min(text.size(), piece.size() + 1));
  return piece;
}

/// "a, b, c": the text of each item, if it has one.
template <class Items, class TextOf = std::identity>
std::string listed(const Items& items, TextOf text_of = {}) {
  std::string list;
  for (const auto& item : items) {
    const auto& text = std::invoke(text_of, item);
    if (std::string_view(text).empty()) continue;
    list.append(list.empty() ? "" : ", ").append(text);
  }
  return list;
}

/// The number that all of `text` is, by std::from_chars(); or std::nullopt. `base`: of a whole number, if it
/// is not 10.
template <class Number, class... Base>
std::optional<Number> number_in(std::string_view text, Base... base) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base...);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

}  // namespace adit::icd
