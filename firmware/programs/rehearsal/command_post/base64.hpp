#pragma once

#include <cstddef>
#include <expected>
#include <optional>
#include <string>
#include <string_view>

namespace adit::rehearsal {

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
