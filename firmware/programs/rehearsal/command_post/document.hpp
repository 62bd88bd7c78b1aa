#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace adit::rehearsal {

/// What came in.
using Json = nlohmann::json;

/// What goes out: members stay in the order they were written.
using OrderedJson = nlohmann::ordered_json;

/// One line of JSON; bytes that are not UTF-8 become U+FFFD, since names from the wire may hold anything.
template <class AnyJson>
std::string line_of(const AnyJson& value) {
  return value.dump(-1, ' ', false, AnyJson::error_handler_t::replace);
}

/// The fewest digits that give the same double back.
std::string text_of(double number);

/// A well-formed body, and its faults.
struct Document {
  Json value;
  std::optional<std::string> repeated;  // a member that some object holds twice
};

enum class Format : std::uint8_t { JsonText, CborBytes };

/// Reads a whole body: JSON (RFC 8259, without a byte order mark) or CBOR (RFC 8949, text in UTF-8, no tags),
/// nothing after it, nested no deeper than 64, at most 4 million values. An error says why it is none.
std::expected<Document, std::string> read_document(std::string_view body, Format format);

/// RFC 4648 4: the standard alphabet, padded, with no other character in it. Nothing where it is not that.
std::optional<std::string> base64_decoded(std::string_view text);

enum class InflateFault {
  Broken,    // no such stream, cut short, or a wrong checksum
  TooLarge,  // grows over the limit
  Followed,  // one whole stream, and bytes after it (a second member, or anything else)
};

/// Exactly one gzip member (RFC 1952), of at most `most` bytes once inflated.
std::expected<std::string, InflateFault> gunzip(std::string_view bytes, std::size_t most);

/// A body under Content-Encoding: deflate, which clients send as zlib (RFC 1950) or bare (RFC 1951).
std::expected<std::string, InflateFault> inflate_body(std::string_view bytes, std::size_t most);

}  // namespace adit::rehearsal
