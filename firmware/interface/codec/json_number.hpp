#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

/// Classes of JSON characters by table, for speed.
namespace adit::codec {

/// White space (RFC 8259 section 2).
constexpr bool is_blank(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

inline constexpr std::array<bool, 256> kStandsForItself = [] {
  std::array<bool, 256> plain{};
  for (std::size_t c = 0x20; c < 0x80; ++c) plain[c] = c != '"' && c != '\\';
  return plain;
}();

/// ASCII without special meaning in a string.
constexpr bool is_plain(char c) {
  return kStandsForItself[static_cast<unsigned char>(c)];
}

/// The grammar of a JSON number (RFC 8259 section 6), read in pieces of any size.
class JsonNumber {
 public:
  /// Bytes of `in` that continue the number; fewer than all at its end.
  std::size_t next(std::string_view in);

  /// Whether it may end here.
  bool complete() const {
    return place_ == Place::Zero || place_ == Place::Integer || place_ == Place::Fraction ||
           place_ == Place::Exponent;
  }
  bool has_exponent() const { return place_ == Place::Exponent; }
  /// Whether it is "0" or "-0" so far, so that no digit may follow.
  bool zero() const { return place_ == Place::Zero; }

 private:
  enum class Place : std::uint8_t { Start, Minus, Zero, Integer, Point, Fraction, E, Sign, Exponent };
  bool accept(char c);

  Place place_ = Place::Start;
};

/// Whether the valid number `text`, which `grammar` has read, is in a double's range.
bool is_finite(const JsonNumber& grammar, std::string_view text);

/// Takes the valid number off the start of `text`, as the nearest double; 0 or infinite if out of range.
double take_json_number(std::string_view& text);

}  // namespace adit::codec
