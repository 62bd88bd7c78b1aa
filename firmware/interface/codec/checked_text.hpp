#pragma once

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

}  // namespace adit::codec
