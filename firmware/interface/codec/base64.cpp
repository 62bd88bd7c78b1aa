#include "codec/base64.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "codec/utf8.hpp"
#include "icd/try.hpp"

namespace adit::codec {
namespace {

constexpr std::uint8_t kNone = 0xFF;

constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::uint8_t, 256> kSextets = [] {
  std::array<std::uint8_t, 256> sextets{};
  sextets.fill(kNone);
  for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
    sextets[static_cast<std::uint8_t>(kAlphabet[i])] = static_cast<std::uint8_t>(i);
  }
  return sextets;
}();

/// What each character adds to the three bytes of its group. The first byte is the word's lowest.
using Addends = std::array<std::uint32_t, 256>;
constexpr std::uint32_t kBad = 1U << 24;  // not in the alphabet
constexpr std::array<Addends, 4> kAddends = [] {
  std::array<Addends, 4> places{};
  for (auto& place : places) place.fill(kBad);
  for (std::size_t c = 0; c < kSextets.size(); ++c) {
    const std::uint32_t value = kSextets[c];
    if (value == kNone) continue;
    places[0][c] = value << 2;
    places[1][c] = value >> 4 | (value & 0x0F) << 12;
    places[2][c] = value >> 2 << 8 | (value & 0x03) << 22;
    places[3][c] = value << 16;
  }
  return places;
}();

constexpr std::size_t kGroup = 4, kBytes = 3;
constexpr std::size_t kBlock = 8;  // groups decoded together

std::uint8_t sextet(char c) {
  return kSextets[static_cast<std::uint8_t>(c)];
}

std::uint32_t group(const char* characters) {
  const auto at = [&](std::size_t i) { return kAddends[i][static_cast<std::uint8_t>(characters[i])]; };
  return at(0) | at(1) | at(2) | at(3);
}

/// Writes three bytes, and a fourth without meaning.
void put(std::uint32_t word, std::uint8_t* out) {
  if constexpr (std::endian::native == std::endian::big) word = std::byteswap(word);
  std::memcpy(out, &word, sizeof word);
}

}  // namespace

std::size_t Base64Decoder::decode_groups(std::string_view& run, std::span<std::uint8_t> out) {
  if (pending_ != 0) return 0;
  const char* from = run.data();
  const char* const end = from + run.size();
  std::uint8_t* to = out.data();
  const std::uint8_t* const full = to + out.size();
  const auto room = [&] { return static_cast<std::size_t>(full - to); };
  const auto left = [&] { return static_cast<std::size_t>(end - from); };
  while (left() >= kBlock * kGroup && room() > kBlock * kBytes) {
    std::uint32_t all = 0;
    for (std::size_t i = 0; i < kBlock; ++i) {
      const std::uint32_t word = group(from + kGroup * i);
      all |= word;
      put(word, to + kBytes * i);
    }
    if ((all & kBad) != 0) break;
    from += kBlock * kGroup;
    to += kBlock * kBytes;
  }
  while (left() >= kGroup && room() > kBytes) {
    const std::uint32_t word = group(from);
    if ((word & kBad) != 0) break;
    put(word, to);
    from += kGroup;
    to += kBytes;
  }
  const auto read = static_cast<std::size_t>(from - run.data());
  run.remove_prefix(read);
  characters_ += read;
  return static_cast<std::size_t>(to - out.data());
}

std::expected<void, std::string> Base64Decoder::feed(char c) {
  const auto bad = [&](std::string_view what) {
    return std::unexpected("character " + std::to_string(characters_) + ": " + std::string(what));
  };
  if (c == '=') {
    if (padding_ == 0 ? pending_ < 2 : pending_ + padding_ >= 4) return bad("unexpected '='");
    ++padding_;
  } else {
    if (padding_ > 0) return bad("unexpected character after the padding");
    const std::uint8_t value = sextet(c);
    if (value == kNone) return bad(byte_name(c) + " is not in the base64 alphabet");
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
      written += decode_groups(run, out.subspan(written));
      if (run.empty() || written + 3 > out.size()) break;
    }
    ADIT_TRY(feed(run.front()));
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

std::string base64_of(std::span<const std::uint8_t> bytes) {
  std::string text;
  text.reserve((bytes.size() + kBytes - 1) / kBytes * kGroup);
  for (std::size_t at = 0; at < bytes.size(); at += kBytes) {
    const std::size_t count = std::min(kBytes, bytes.size() - at);
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < kBytes; ++i) word = word << 8 | (i < count ? bytes[at + i] : 0U);
    for (std::size_t i = 0; i < kGroup; ++i) text += i <= count ? kAlphabet[word >> (18 - 6 * i) & 63] : '=';
  }
  return text;
}

}  // namespace adit::codec
