#include "spare/code.hpp"

namespace adit::spare {
namespace {

constexpr std::size_t kGroup = 4;

}  // namespace

std::string draw_code(const std::array<std::uint8_t, kCodeDigits>& random) {
  // The low decimal digits of a number of 128 bits. Their probabilities differ by less than 1 in 2^70.
  std::array<std::uint8_t, kCodeDigits> number = random;
  std::string code;
  for (std::size_t i = 0; i < kCodeDigits; ++i) {
    unsigned rest = 0;
    for (std::uint8_t& byte : number) {
      rest = rest << 8 | byte;
      byte = static_cast<std::uint8_t>(rest / 10);
      rest %= 10;
    }
    code += static_cast<char>('0' + rest);
  }
  return code;
}

std::string spoken(std::string_view code) {
  std::string text;
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (i != 0 && i % kGroup == 0) text += ' ';
    text += code[i];
  }
  return text;
}

std::optional<std::string> code_in(std::string_view typed) {
  std::string code;
  for (const char each : typed) {
    if (each == ' ' || each == '-') continue;
    if (each < '0' || each > '9' || code.size() == kCodeDigits) return std::nullopt;
    code += each;
  }
  if (code.size() != kCodeDigits) return std::nullopt;
  return code;
}

}  // namespace adit::spare
