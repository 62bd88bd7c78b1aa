#pragma once

#include <optional>
#include <string_view>

#include "codec/value.hpp"

namespace adit::codec {

/// A document by cJSON, where that reads it as RFC 8259 has it without a second look: ASCII without escapes,
/// shallow, its numbers short. Most of what is read in one piece is like that. Nothing: it is another, or not
/// well-formed.
std::optional<Value> plain_json(std::string_view text);

}  // namespace adit::codec
