#pragma once

#include <cstdint>
#include <cstdio>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace adit::host {

/// A word that stands alone, and the member that it makes true.
template <class Options>
using Flag = std::pair<std::string_view, bool Options::*>;
/// A word that wants a value, and the member that gets it.
template <class Options>
using Value = std::pair<std::string_view, std::string Options::*>;

/// Whether a value may be "".
enum class Empty : std::uint8_t { Refused, Taken };

/// A program's command line by the tables of its words; of a word that comes twice, the last counts. What is
/// wrong names the word it is about.
template <class Options>
std::expected<Options, std::string> read_command_line(std::span<char* const> arguments,
                                                      std::span<const Flag<Options>> flags,
                                                      std::span<const Value<Options>> values,
                                                      Empty empty = Empty::Refused) {
  const auto member_named = [](const auto& table, std::string_view word) {
    for (const auto& [name, member] : table) {
      if (name == word) return member;
    }
    return decltype(table[0].second){};
  };
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view word = arguments[i];
    if (const auto flag = member_named(flags, word)) {
      options.*flag = true;
    } else if (const auto value = member_named(values, word); value == nullptr) {
      return std::unexpected("unknown word '" + std::string(word) + "'");
    } else if (++i == arguments.size() || (empty == Empty::Refused && *arguments[i] == '\0')) {
      return std::unexpected(std::string(word) + " wants a value");
    } else {
      options.*value = arguments[i];
    }
  }
  return options;
}

/// What main() returns at once: 2 and the usage for a wrong command line, 0 where only help or the version
/// was wanted (1 where that cannot be printed); nothing: the program is to do its work.
template <class Options>
std::optional<int> answered(const char* program, const char* version, const char* usage,
                            const std::expected<Options, std::string>& options) {
  if (!options) {
    std::fprintf(stderr, "%s: %s\n%s", program, options.error().c_str(), usage);
    return 2;
  }
  if (options->help) return std::fputs(usage, stdout) < 0 ? 1 : 0;
  if (options->version) return std::printf("%s %s\n", program, version) < 0 ? 1 : 0;
  return std::nullopt;
}

}  // namespace adit::host
