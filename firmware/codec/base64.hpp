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

  /// The last bytes, at most two, at the end of the text.
  std::expected<std::size_t, std::string> finish(std::span<std::uint8_t, 2> out);

 private:
  std::size_t decode_quads(std::string_view& run, std::span<std::uint8_t> out);
  std::expected<void, std::string> take(char c);

  std::uint32_t bits_ = 0;      // of the characters of an unfinished group of four
  int pending_ = 0;             // how many these are
  int padding_ = 0;             // how many '=' have come
  std::size_t characters_ = 0;  // before this one, for sentences
};

}  // namespace adit::codec
