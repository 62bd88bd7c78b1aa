#include "codec/json_number.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <system_error>

#include "icd/text.hpp"

namespace adit::codec {

std::size_t JsonNumber::next(std::string_view in) {
  const char* at = in.data();
  const char* const end = at + in.size();
  while (at != end && accept(*at)) {
    ++at;
    const bool is_among_digits =
        place_ == Place::Integer || place_ == Place::Fraction || place_ == Place::Exponent;
    if (is_among_digits) at = std::find_if_not(at, end, icd::is_digit);
  }
  return static_cast<std::size_t>(at - in.data());
}

bool JsonNumber::accept(char c) {
  const bool digit = icd::is_digit(c);
  const auto go = [this](Place place) {
    place_ = place;
    return true;
  };
  switch (place_) {
    case Place::Start:
      if (c == '-') return go(Place::Minus);
      [[fallthrough]];
    case Place::Minus:
      if (c == '0') return go(Place::Zero);
      return digit && go(Place::Integer);
    case Place::Integer:
      if (digit) return true;
      [[fallthrough]];
    case Place::Zero:
      if (c == '.') return go(Place::Point);
      return (c == 'e' || c == 'E') && go(Place::E);
    case Place::Fraction:
      if (c == 'e' || c == 'E') return go(Place::E);
      [[fallthrough]];
    case Place::Point:
      return digit && go(Place::Fraction);
    case Place::E:
      if (c == '+' || c == '-') return go(Place::Sign);
      [[fallthrough]];
    case Place::Sign:
    case Place::Exponent:
      return digit && go(Place::Exponent);
  }
  return false;
}

bool is_finite(const JsonNumber& grammar, std::string_view text) {
  constexpr std::size_t kSurelySmall = 308;  // digits, without an exponent: below 1e308
  return (text.size() <= kSurelySmall && !grammar.has_exponent()) || !std::isinf(take_json_number(text));
}

double take_json_number(std::string_view& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const auto length = static_cast<std::size_t>(end - text.data());
  // strtod(3) tells underflow from overflow.
  if (error != std::errc{}) number = std::strtod(std::string(text.substr(0, length)).c_str(), nullptr);
  text.remove_prefix(length);
  return number;
}

}  // namespace adit::codec
