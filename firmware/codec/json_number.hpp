#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace adit::codec {

/// The grammar of one JSON number (RFC 8259 section 6), given in pieces of any size.
class JsonNumber {
 public:
  /// How many bytes of `in` carry the number on: all of them, or fewer when it has ended.
  std::size_t next(std::string_view in);

  /// It may end here.
  bool complete() const {
    return place_ == Place::Zero || place_ == Place::Integer || place_ == Place::Fraction ||
           place_ == Place::Exponent;
  }
  bool has_exponent() const { return place_ == Place::Exponent; }
  /// It is "0" or "-0" so far: no digit may follow.
  bool zero() const { return place_ == Place::Zero; }

 private:
  enum class Place : std::uint8_t { Start, Minus, Zero, Integer, Point, Fraction, E, Sign, Exponent };
  bool accept(char c);

  Place place_ = Place::Start;
};

/// Whether a double holds the number `text`, whose grammar has been read.
bool is_finite(const JsonNumber& grammar, std::string_view text);

/// Takes such a number, as which `text` begins, and gives what it means as a double, rounded to the nearest:
/// 0 or infinite where it is too small or too large for one.
double take_json_number(std::string_view& text);

}  // namespace adit::codec
