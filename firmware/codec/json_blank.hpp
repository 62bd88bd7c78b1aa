#pragma once

namespace adit::codec {

/// White space of JSON (RFC 8259 section 2). Not by searching in a list of them: this is asked of every
/// second character.
constexpr bool is_blank(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

}  // namespace adit::codec
