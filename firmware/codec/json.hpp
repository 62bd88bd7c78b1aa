#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "codec/value.hpp"

namespace adit::codec {

/// A whole JSON document (RFC 8259, strictly, nesting up to 64), or why it is none, with the byte it is
/// about.
std::expected<Value, std::string> parse_json(std::string_view text);

/// The value on one line; Bytes, UnderTag and SplitOut as null. A number keeps its kind: 11.0 is not
/// written 11.
std::string write_json(const Value& value);

}  // namespace adit::codec
