#include "command_line/number.hpp"

#include <charconv>

namespace adit::command_line {
namespace {

template <class Number>
Wrong read(const std::string& text, Number least, Number most, Number& number) {
  const char* const past = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), past, number);
  if (error == std::errc() && end == past && number >= least && number <= most) return std::nullopt;
  const auto written = [](Number bound) {
    char digits[64];
    return std::string(digits, std::to_chars(digits, digits + sizeof digits, bound).ptr);
  };
  return "expected " + written(least) + " to " + written(most) + ", got '" + text + "'";
}

}  // namespace

Wrong read_number(const std::string& text, double least, double most, double& number) {
  return read(text, least, most, number);
}
Wrong read_number(const std::string& text, std::uint64_t least, std::uint64_t most, std::uint64_t& number) {
  return read(text, least, most, number);
}

}  // namespace adit::command_line
