#pragma once

#include <charconv>
#include <cstdint>
#include <expected>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace adit::robots {

/// A file's whole text, up to 256 MiB.
std::expected<std::string, std::string> read_file(const std::filesystem::path& file);

/// Takes the next line off `rest`, without its \n or \r\n. Nothing at the end.
std::optional<std::string_view> take_line(std::string_view& rest);

/// The words of a line, split at blanks.
std::vector<std::string_view> words_of(std::string_view line);

/// All of `text` as one number, and nothing else.
template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace adit::robots
