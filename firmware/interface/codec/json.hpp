#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "codec/value.hpp"

namespace adit::codec {

/// Parses a whole JSON document (RFC 8259 strictly, nesting up to 64). The error names the byte.
std::expected<Value, std::string> parse_json(std::string_view text);

/// Writes one line. Bytes, TaggedValue and SplitOut become null. A number keeps its kind: 11.0 stays 11.0.
std::string write_json(const Value& value);

}  // namespace adit::codec
