#pragma once

#include <optional>
#include <string_view>

#include "codec/value.hpp"

namespace adit::codec {

/// Reads a document with cJSON if it has only features that cJSON reads like RFC 8259: ASCII without escapes,
/// little nesting, short numbers. Most documents in one piece are so. std::nullopt: another document, or not
/// well-formed.
std::optional<Value> plain_json(std::string_view text);

}  // namespace adit::codec
