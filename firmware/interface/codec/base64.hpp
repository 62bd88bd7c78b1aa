#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <string_view>

namespace adit::codec {

/// Decodes base64 (RFC 4648 section 4) in pieces of any size. Padding may be absent, but not incomplete.
/// Surplus bits of the last character are ignored.
class Base64Decoder {
 public:
  /// Decodes as much of `run` as fits `out` and removes it from `run`. Returns the number of bytes written.
  /// The error names the fault and the position of the character.
  std::expected<std::size_t, std::string> decode(std::string_view& run, std::span<std::uint8_t> out);

  /// Fast path for text that may continue after the base64. Decodes whole groups of four valid characters,
  /// which have no special meaning in JSON. Stops at the first other group, or if `out` has room for fewer
  /// than four bytes. Without effect inside a group.
  std::size_t decode_groups(std::string_view& run, std::span<std::uint8_t> out);
  /// Characters that complete the present or next group: 1 to 4.
  std::size_t missing() const { return static_cast<std::size_t>(4 - pending_); }

  /// Decodes the last bytes, at most two, at the end of the text.
  std::expected<std::size_t, std::string> finish(std::span<std::uint8_t, 2> out);

 private:
  std::expected<void, std::string> feed(char c);

  std::uint32_t bits_ = 0;      // of an unfinished group
  int pending_ = 0;             // number of its characters
  int padding_ = 0;             // number of '='
  std::size_t characters_ = 0;  // read before, for error sentences
};

/// Padded base64 of `bytes` (RFC 4648 section 4).
std::string base64_of(std::span<const std::uint8_t> bytes);

}  // namespace adit::codec
