#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>

#include "codec/value.hpp"

namespace adit::codec {

/// Reads a whole JSON document (RFC 8259) in one pass. std::nullopt: not well-formed, a byte order mark, more
/// than `most_values` values, or nesting beyond BodyDecoder::kDeepest; JsonSplitter tells which.
std::optional<Value> json_value(std::string_view text,
                                std::size_t most_values = std::numeric_limits<std::size_t>::max());
/// The same with arrays left as text. At most kMostOutsideLists values are outside of them.
std::optional<Value> json_value_with_lists(const SharedText& text, std::size_t most_values);

/// A JSON number: an integer if it stands for exactly one.
Value json_number_value(double number);

}  // namespace adit::codec
