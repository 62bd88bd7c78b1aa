#pragma once

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

}  // namespace adit::rehearsal
