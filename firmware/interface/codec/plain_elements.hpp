#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace adit::codec {

/// Equal elements in sequence.
struct PlainElements {
  std::uint8_t value = 0;  // 255 for -1
  std::size_t count = 0;
};

/// Removes elements and their commas from the start of a JSON array in `text`: integers from 0 to 255 or -1,
/// with white space. Takes elements together if their text is the same, because a map's cells mostly equal
/// their neighbours. std::nullopt, with `text` unchanged, if there is no such element with a comma; the
/// general reader decides then.
std::optional<PlainElements> take_plain_elements(std::string_view& text);

/// The same for a CBOR array: elements of one or two bytes, 0 to 255 or -1 (RFC 8949 3.1), at most `most`.
/// Requires most > 0.
std::optional<PlainElements> take_plain_cbor_elements(std::string_view& bytes, std::uint64_t most);

}  // namespace adit::codec
