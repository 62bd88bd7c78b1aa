#pragma once

#include <chrono>
#include <expected>
#include <string>

#include "settings/settings.hpp"

namespace adit::cli {

inline constexpr std::size_t kLargestBody = 8u << 20;

/// One blocking GET (RFC 9112): the body of a 200, or a sentence that names the address. All of it within
/// `within`. It asks on a connection of its own and shows no token.
std::expected<std::string, std::string> http_get(const settings::Address& address, const std::string& target,
                                                 std::chrono::milliseconds within);

}  // namespace adit::cli
