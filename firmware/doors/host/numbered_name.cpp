#include "host/numbered_name.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cinttypes>
#include <cstdio>

#include "host/files.hpp"
#include "host/service.hpp"
#include "icd/text.hpp"

namespace adit::host {

std::string numbered_name(std::string_view prefix, std::uint64_t number, std::string_view ending) {
  std::array<char, 24> digits{};
  const int length = std::snprintf(digits.data(), digits.size(), "%08" PRIu64, number);
  return std::string(prefix).append(digits.data(), static_cast<std::size_t>(length)).append(ending);
}

std::optional<std::uint64_t> number_in_name(std::string_view name, std::string_view prefix,
                                            std::string_view ending) {
  if (!name.starts_with(prefix)) return std::nullopt;
  name.remove_prefix(prefix.size());
  if (!name.ends_with(ending)) return std::nullopt;
  name.remove_suffix(ending.size());
  return icd::number_in<std::uint64_t>(name);
}

std::expected<std::vector<std::uint64_t>, std::string> numbers_in(const std::string& folder,
                                                                  std::string_view prefix,
                                                                  std::string_view ending) {
  std::vector<std::uint64_t> numbers;
  const auto read = for_each_name(folder, [&](std::string_view name) {
    if (const auto number = number_in_name(name, prefix, ending)) numbers.push_back(*number);
    return true;
  });
  if (!read && read.error() != ENOENT) return std::unexpected(trouble(folder, read.error()));
  std::ranges::sort(numbers);
  return numbers;
}

}  // namespace adit::host
