#include "rehearsal/command_post/base64.hpp"

#include <sodium/utils.h>
#include <zlib.h>

#include <cstddef>
#include <vector>

namespace adit::rehearsal {
std::optional<std::string> base64_decoded(std::string_view text) {
  std::string bytes(text.size() / 4 * 3, '\0');
  std::size_t size = 0;
  const int wrong =
      sodium_base642bin(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(), text.data(),
                        text.size(), nullptr, &size, nullptr, sodium_base64_VARIANT_ORIGINAL);
  if (wrong != 0) return std::nullopt;
  bytes.resize(size);
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
