#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace adit::robots {

/// One gzip member (RFC 1952).
std::vector<std::uint8_t> gzip(std::span<const std::uint8_t> bytes);

/// RFC 4648 section 4, padded.
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace adit::robots
