#pragma once

#include "command_line/program.hpp"

namespace adit::command_line {

/// nullopt if `text` is a number from `least` to `most`, which is then in `number`.
[[gnu::cold]] Wrong read_number(const std::string& text, double least, double most, double& number);
[[gnu::cold]] Wrong read_number(const std::string& text, std::uint64_t least, std::uint64_t most,
                                std::uint64_t& number);

/// Stores a number from Least to Most in `into`. It must be whole if Least is an integer.
template <auto Least, decltype(Least) Most, class Into>
Take number(Into& into) {
  return take<[](Into& place, const std::string& text) {
    std::conditional_t<std::is_integral_v<decltype(Least)>, std::uint64_t, double> number = 0;
    auto wrong = read_number(text, Least, Most, number);
    if (!wrong) place = Into(number);
    return wrong;
  }>(into);
}

}  // namespace adit::command_line
