#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <string_view>

namespace adit::codec {

/// Decodes base64 (RFC 4648 section 4) given in runs of any size. Padding may be left away, but not half of
/// it; bits that a last character has over are ignored.
class Base64Decoder {
 public:
  /// Decodes as much of `run` as fits `out`; `run` keeps what did not fit. Gives the number of bytes written.
  /// The error says what is wrong with the text and at which of its characters.
  std::expected<std::size_t, std::string> decode(std::string_view& run, std::span<std::uint8_t> out);

  /// The fast way, one pass over text that may have more behind it than base64: decodes whole groups of four
  /// good characters, of which a string of JSON has none that means something to JSON, and stops before the
  /// first that is none, or where `out` has no room for four bytes. Nothing within a group.
  std::size_t decode_groups(std::string_view& run, std::span<std::uint8_t> out);
  /// How many characters the group that comes next, or is unfinished, still wants: 1 to 4.
  std::size_t missing() const { return static_cast<std::size_t>(4 - pending_); }

  /// The last bytes, at most two, at the end of the text.
  std::expected<std::size_t, std::string> finish(std::span<std::uint8_t, 2> out);

 private:
  std::expected<void, std::string> take(char c);

  std::uint32_t bits_ = 0;      // of the characters of an unfinished group of four
  int pending_ = 0;             // how many these are
  int padding_ = 0;             // how many '=' have come
  std::size_t characters_ = 0;  // before this one, for sentences
};

/// Base64 of `bytes`, padded (RFC 4648 section 4).
std::string base64_of(std::span<const std::uint8_t> bytes);

}  // namespace adit::codec
