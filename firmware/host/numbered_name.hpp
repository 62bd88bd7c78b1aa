#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace adit::host {

/// The name of a file that is one of many, with at least eight digits: "map-00000012.cbor".
std::string numbered_name(std::string_view prefix, std::uint64_t number, std::string_view ending = "");

/// The number in such a name, however many digits it has; nothing for another file's name.
std::optional<std::uint64_t> number_in_name(std::string_view name, std::string_view prefix,
                                            std::string_view ending = "");

/// The numbers of the files of such names in a folder, in order; none where there is no such folder. An error
/// names the folder: it cannot be read to its end.
std::expected<std::vector<std::uint64_t>, std::string> numbers_in(const std::string& folder,
                                                                  std::string_view prefix,
                                                                  std::string_view ending = "");

}  // namespace adit::host
