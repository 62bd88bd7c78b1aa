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
/// A document that a JsonSplitter has passed and kept; its arrays are left as text. 413: as List::element().
icd::Checked<Value> json_value_with_lists(std::string text);

/// A number of JSON: an integer where it surely stands for that one alone.
Value json_number_value(double number);

}  // namespace adit::codec
