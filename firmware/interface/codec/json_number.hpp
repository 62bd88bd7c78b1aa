#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace adit::codec {

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

/// Removes the valid number at the start of `text` and returns it as the nearest double; 0 or infinite if out
/// of range.
double take_json_number(std::string_view& text);

}  // namespace adit::codec
