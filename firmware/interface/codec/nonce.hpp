#pragma once

#include <cstddef>
#include <string_view>

#include "codec/row.hpp"

namespace adit::codec {

inline constexpr std::size_t kNonceDigits = 32;

/// Whether a text has 32 hexadecimal digits, the name of a request to a root program.
constexpr bool is_nonce(std::string_view text) {
  return text.size() == kNonceDigits && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

inline constexpr Form kNonce{is_nonce, "32 hexadecimal digits"};

}  // namespace adit::codec
