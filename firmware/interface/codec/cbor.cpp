#include "codec/cbor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "icd/require.hpp"
#include "icd/sentence.hpp"

namespace adit::codec {
namespace {

constexpr std::uint64_t kStringReference = 25, kSharedReference = 29;

/// A half-precision number (RFC 8949 appendix D).
double half(std::uint16_t bits) {
  const int exponent = (bits >> 10) & 0x1F;
  const int mantissa = bits & 0x3FF;
  double value = 0;
  if (exponent == 0) {
    value = std::ldexp(mantissa, -24);
  } else if (exponent != 31) {
    value = std::ldexp(mantissa + 1024, exponent - 25);
  } else {
    value =
        mantissa == 0 ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  }
  return (bits & 0x8000) != 0 ? -value : value;
}

}  // namespace

bool is_remark(std::uint64_t tag) {
  static constexpr auto kRemarks = std::to_array<std::uint64_t>({
      0,     1,                      // time as text, and in seconds
      21,    22,    23,  108,        // preferred encoding of bytes
      28,    256,   296, 22098,      // reference scopes; references (25, 29) are no annotations
      32,    33,    34,  35,    36,  // kinds of text
      39,                            // an identifier
      41,    258,                    // of an array: equal types; a set
      64,    68,    72,              // RFC 8746: bytes as an array of single bytes
      201,   55799,                  // content is CBOR
      259,   275,                    // of a map: a map; text keys
      266,   267,   301, 1004,       // more kinds of text
      21065,
  });
  return std::ranges::find(kRemarks, tag) != kRemarks.end();
}

bool is_reference(std::uint64_t tag) {
  return tag == kStringReference || tag == kSharedReference;
}

std::string tag_that_changes(std::uint64_t tag) {
  constexpr std::uint64_t kFirstTyped = 65, kLastTyped = 87;
  if (is_reference(tag))
    return icd::sentence("CBOR tag ", tag, ", a reference to an earlier ",
                         tag == kStringReference ? "string" : "value",
                         ": switch references off in the CBOR library");
  if (tag >= kFirstTyped && tag <= kLastTyped)
    return icd::sentence("CBOR tag ", tag, ", a typed array: send plain numbers, or in msg.data its bytes");
  return icd::sentence("CBOR tag ", tag, ", which changes the meaning of its value");
}

std::size_t CborHead::next(std::string_view in) {
  icd::require(!complete());
  if (size_ == 0 && in.size() >= bytes_.size()) {  // the usual case
    std::ranges::copy(in.substr(0, bytes_.size()), bytes_.data());
    return size_ = length();
  }
  std::size_t taken = 0;
  if (size_ == 0 && !in.empty()) bytes_[size_++] = static_cast<std::uint8_t>(in[taken++]);
  const std::string_view rest = in.substr(taken, length() - size_);
  std::ranges::copy(rest, bytes_.data() + size_);
  size_ += rest.size();
  return taken + rest.size();
}

std::uint64_t CborHead::argument() const {
  if (info() < 24) return info();
  std::uint64_t value = 0;
  for (std::size_t i = 1; i < size_; ++i) value = value << 8 | bytes_[i];
  return value;
}

double CborHead::number() const {
  switch (info()) {
    case 25:
      return half(static_cast<std::uint16_t>(argument()));
    case 26:
      return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(argument())));
    default:
      return std::bit_cast<double>(argument());
  }
}

/// Writes the head, then `number` in `size` bytes, the highest first.
void CborWriter::head(Major major, std::uint8_t info, std::uint64_t number, std::size_t size) {
  if (latest_.size() - used_ < 1 + sizeof number) flush();
  latest_[used_++] = static_cast<std::uint8_t>(static_cast<unsigned>(major) << 5 | info);
  if (size == 0) return;
  number <<= 8 * (sizeof number - size);
  if constexpr (std::endian::native == std::endian::little) number = std::byteswap(number);
  std::memcpy(&latest_[used_], &number, sizeof number);
  used_ += size;
}

void CborWriter::head(Major major, std::uint64_t argument) {
  if (argument < 24) return head(major, static_cast<std::uint8_t>(argument), 0, 0);
  if (argument <= 0xFF) return head(major, 24, argument, 1);
  if (argument <= 0xFFFF) return head(major, 25, argument, 2);
  if (argument <= 0xFFFF'FFFF) return head(major, 26, argument, 4);
  head(major, 27, argument, 8);
}

void CborWriter::text(std::string_view utf8) {
  head(Major::Text, utf8.size());
  if (utf8.size() > latest_.size() - used_) flush();
  if (utf8.size() > latest_.size())
    return out_.append({reinterpret_cast<const std::uint8_t*>(utf8.data()), utf8.size()});
  utf8.copy(reinterpret_cast<char*>(latest_.data()) + used_, utf8.size());  // may be empty
  used_ += utf8.size();
}

void CborWriter::integer(std::int64_t number) {
  if (number >= 0) {
    head(Major::Unsigned, static_cast<std::uint64_t>(number));
  } else {
    head(Major::Negative, static_cast<std::uint64_t>(-(number + 1)));
  }
}

void CborWriter::byte_string(const icd::ChunkedBytes& bytes) {
  head(Major::Bytes, bytes.size());
  flush();
  out_.append(bytes);
}

icd::ChunkedBytes CborWriter::finish() {
  flush();
  return std::move(out_);
}

}  // namespace adit::codec
