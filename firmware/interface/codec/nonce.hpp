#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "codec/row.hpp"

namespace adit::codec {

/// The Kind of a text that passes `is_such`; others are refused with `kExpected` ("expected a MAC address").
template <bool (*is_such)(std::string_view), const auto& kExpected>
inline constexpr Kind kCheckedText = {.write = kind_of<std::string>.write,
                                      .read =
                                          [](const Field& field, void* value) {
                                            auto& text = *static_cast<std::string*>(value);
                                            text = field.text();
                                            if (!is_such(text)) field.refuse(kExpected);
                                          },
                                      .schema = kind_of<std::string>.schema,
                                      .same = kind_of<std::string>.same};

inline constexpr std::size_t kNonceDigits = 32;

/// Whether a text has 32 hexadecimal digits, the name of a request to a root program.
constexpr bool is_nonce(std::string_view text) {
  return text.size() == kNonceDigits && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

inline constexpr char kExpectedNonce[] = "expected 32 hexadecimal digits";
/// The kind of that text.
inline constexpr Kind kNonce = kCheckedText<is_nonce, kExpectedNonce>;

}  // namespace adit::codec
