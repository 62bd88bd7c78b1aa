#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace adit::host {

/// The name of a numbered file, with at least eight digits: "map-00000012.cbor".
std::string numbered_name(std::string_view prefix, std::uint64_t number, std::string_view ending = "");

/// The number in such a name, with any count of digits. std::nullopt for other names.
std::optional<std::uint64_t> number_in_name(std::string_view name, std::string_view prefix,
                                            std::string_view ending = "");

/// The numbers of such files in a directory, sorted. Empty if there is no such directory. Error, with the
/// directory's name: it cannot be read completely.
std::expected<std::vector<std::uint64_t>, std::string> numbers_in(const std::string& folder,
                                                                  std::string_view prefix,
                                                                  std::string_view ending = "");

}  // namespace adit::host
