#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "codec/value.hpp"

namespace adit::codec {

/// A JSON document (RFC 8259) read in one pass, if it is as nearly all are: strings of ASCII without
/// escapes, numbers that a double can hold, at most `most_values` values, nested up to
/// BodyDecoder::kDeepest. Nothing: it is another one, or not well-formed; a JsonSplitter tells which.
/// For what comes often: plain_json() reads settings and replies, by cJSON.
std::optional<Value> quick_json(std::string_view text, std::size_t most_values);

}  // namespace adit::codec
