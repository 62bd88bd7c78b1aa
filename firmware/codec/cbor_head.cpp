#include "codec/cbor_head.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "icd/require.hpp"

namespace adit::codec {
namespace {

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

}  // namespace adit::codec
