#include "rehearsal/command_post/base64.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace adit::rehearsal {
namespace {

constexpr std::uint32_t kNone = 64;

constexpr std::array<std::uint8_t, 256> kValues = [] {
  std::array<std::uint8_t, 256> values{};
  values.fill(kNone);
  constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < alphabet.size(); ++i) {
    values[static_cast<unsigned char>(alphabet[i])] = static_cast<std::uint8_t>(i);
  }
  return values;
}();

}  // namespace

std::optional<std::string> base64_decoded(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  std::size_t padding = 0;
  while (padding < 2 && text.ends_with('=')) {
    text.remove_suffix(1);
    ++padding;
  }
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  unsigned held = 0;
  for (const char c : text) {
    const std::uint32_t value = kValues[static_cast<unsigned char>(c)];
    if (value == kNone) return std::nullopt;
    bits = (bits << 6) | value;
    held += 6;
    if (held >= 8) {
      held -= 8;
      bytes.push_back(static_cast<char>((bits >> held) & 0xff));
    }
  }
  // What is left over is the filling of the last character, and must be zeros (RFC 4648 3.5).
  if ((bits & ((1U << held) - 1)) != 0) return std::nullopt;
  return bytes;
}

namespace {

constexpr int kGzip = 15 + 16;
constexpr int kZlib = 15;
constexpr int kBare = -15;
constexpr std::size_t kInflatedPiece = std::size_t{256} << 10;

/// `window` as inflateInit2 takes it. Bodies are below 4 GiB, so that zlib's counters hold them.
std::expected<std::string, InflateFault> inflate_one(std::string_view bytes, int window, std::size_t most) {
  z_stream stream{};
  if (inflateInit2(&stream, window) != Z_OK) return std::unexpected(InflateFault::Broken);
  // zlib does not write through next_in; its type is from before const.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  std::vector<char> piece(kInflatedPiece);
  std::string out;
  int state = Z_OK;
  while (state == Z_OK && out.size() <= most) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    state = inflate(&stream, Z_NO_FLUSH);
    out.append(piece.data(), piece.size() - stream.avail_out);
  }
  const bool followed = stream.avail_in > 0;
  inflateEnd(&stream);
  if (out.size() > most) return std::unexpected(InflateFault::TooLarge);
  if (state != Z_STREAM_END) return std::unexpected(InflateFault::Broken);
  if (followed) return std::unexpected(InflateFault::Followed);
  return out;
}

}  // namespace

std::expected<std::string, InflateFault> gunzip(std::string_view bytes, std::size_t most) {
  return inflate_one(bytes, kGzip, most);
}

std::expected<std::string, InflateFault> inflate_body(std::string_view bytes, std::size_t most) {
  auto inflated = inflate_one(bytes, kZlib, most);
  return inflated ? inflated : inflate_one(bytes, kBare, most);
}

}  // namespace adit::rehearsal
