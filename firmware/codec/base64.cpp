#include "codec/base64.hpp"

#include "codec/byte_name.hpp"

namespace adit::codec {
namespace {

constexpr std::uint8_t kNone = 0xFF;

constexpr std::array<std::uint8_t, 256> kSextets = [] {
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::uint8_t, 256> sextets{};
  sextets.fill(kNone);
  for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
    sextets[static_cast<std::uint8_t>(kAlphabet[i])] = static_cast<std::uint8_t>(i);
  }
  return sextets;
}();

std::uint8_t sextet(char c) {
  return kSextets[static_cast<std::uint8_t>(c)];
}

}  // namespace

/// The fast way: whole groups of four good characters, three bytes each.
std::size_t Base64Decoder::decode_quads(std::string_view& run, std::span<std::uint8_t> out) {
  std::size_t read = 0;
  std::size_t written = 0;
  while (read + 4 <= run.size() && written + 3 <= out.size()) {
    const std::uint8_t a = sextet(run[read]);
    const std::uint8_t b = sextet(run[read + 1]);
    const std::uint8_t c = sextet(run[read + 2]);
    const std::uint8_t d = sextet(run[read + 3]);
    if (((a | b | c | d) & 0xC0) != 0) break;
    out[written] = static_cast<std::uint8_t>(a << 2 | b >> 4);
    out[written + 1] = static_cast<std::uint8_t>(b << 4 | c >> 2);
    out[written + 2] = static_cast<std::uint8_t>(c << 6 | d);
    read += 4;
    written += 3;
  }
  run.remove_prefix(read);
  characters_ += read;
  return written;
}

std::expected<void, std::string> Base64Decoder::take(char c) {
  const auto bad = [&](std::string_view what) {
    return std::unexpected("character " + std::to_string(characters_) + ": " + std::string(what));
  };
  if (c == '=') {
    if (padding_ == 0 ? pending_ < 2 : pending_ + padding_ >= 4) return bad("'=' where none belongs");
    ++padding_;
  } else {
    if (padding_ > 0) return bad("something after the padding");
    const std::uint8_t value = sextet(c);
    if (value == kNone) return bad(byte_name(c) + " is not of the base64 alphabet");
    bits_ = bits_ << 6 | value;
    ++pending_;
  }
  ++characters_;
  return {};
}

std::expected<std::size_t, std::string> Base64Decoder::decode(std::string_view& run,
                                                              std::span<std::uint8_t> out) {
  std::size_t written = 0;
  while (!run.empty() && written + 3 <= out.size()) {
    if (pending_ == 0) {
      written += decode_quads(run, out.subspan(written));
      if (run.empty() || written + 3 > out.size()) break;
    }
    if (const auto taken = take(run.front()); !taken) return std::unexpected(taken.error());
    run.remove_prefix(1);
    if (pending_ == 4) {
      for (const int shift : {16, 8, 0}) out[written++] = static_cast<std::uint8_t>(bits_ >> shift);
      pending_ = 0;
    }
  }
  return written;
}

std::expected<std::size_t, std::string> Base64Decoder::finish(std::span<std::uint8_t, 2> out) {
  if (padding_ > 0 && pending_ + padding_ != 4) return std::unexpected("the base64 padding is cut short");
  if (pending_ == 1) return std::unexpected("the base64 text is cut short");
  if (pending_ == 0) return 0;
  const std::uint32_t bits = bits_ << (6 * (4 - pending_));
  out[0] = static_cast<std::uint8_t>(bits >> 16);
  out[1] = static_cast<std::uint8_t>(bits >> 8);
  return static_cast<std::size_t>(pending_ - 1);
}

}  // namespace adit::codec
