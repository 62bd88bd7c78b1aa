#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace adit::codec {

/// The same element, one or many times over.
struct PlainElements {
  std::uint8_t value = 0;  // 255 where -1 stands there
  std::size_t count = 0;
};

/// Takes elements of a JSON array off the beginning of `text`, each with the comma that follows it: integers
/// from 0 to 255 or -1, white space around them. As many as stand there letter by letter the same come
/// together, for a map's cells are mostly those of their neighbours. Nothing, and `text` as it was, where it
/// does not begin with a whole such element and its comma: the general reader says what that is.
std::optional<PlainElements> take_plain_elements(std::string_view& text);

/// The same of a CBOR array: elements of one or two bytes, 0 to 255 or -1 (RFC 8949 3.1), at most `most` of
/// them. Requires most > 0.
std::optional<PlainElements> take_plain_cbor_elements(std::string_view& bytes, std::uint64_t most);

}  // namespace adit::codec
