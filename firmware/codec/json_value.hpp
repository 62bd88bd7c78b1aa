#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "codec/cut_lists.hpp"
#include "codec/value.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// A whole JSON document (RFC 8259), read in one pass. Nothing: the text is not well-formed, begins with a
/// byte order mark, has more than `most_values` values, or is nested deeper than BodyDecoder::kDeepest. A
/// JsonSplitter says which.
std::optional<Value> json_value(std::string_view text,
                                std::size_t most_values = std::numeric_limits<std::size_t>::max());
/// The same, whose arrays are left as text, and of which at most kMostOutsideLists values are outside them.
std::optional<Value> json_value_with_lists(const SharedText& text, std::size_t most_values);

/// A number of JSON: an integer where it surely stands for that one alone.
Value json_number_value(double number);

}  // namespace adit::codec
