#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>

#include "rehearsal/command_post/json.hpp"

namespace adit::rehearsal {

/// A body that was read, and what is wrong with it although it is well-formed.
struct Document {
  Json value;
  std::optional<std::string> repeated;  // a member that some object holds twice
};

enum class Format : std::uint8_t { JsonText, CborBytes };

/// Reads a whole body: JSON (RFC 8259, without a byte order mark) or CBOR (RFC 8949, text in UTF-8, no tags),
/// nothing after it, nested no deeper than 64, at most 4 million values. An error says why it is none.
std::expected<Document, std::string> read_document(std::string_view body, Format format);

}  // namespace adit::rehearsal
