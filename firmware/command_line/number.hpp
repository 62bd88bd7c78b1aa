#pragma once

#include "command_line/program.hpp"

namespace adit::command_line {

/// What is wrong with a number, or nothing where it is from `least` to `most`.
[[gnu::cold]] Wrong read_number(const std::string& text, double least, double most, double& number);
[[gnu::cold]] Wrong read_number(const std::string& text, std::uint64_t least, std::uint64_t most,
                                std::uint64_t& number);

/// Takes a number of that span, a whole one where they are, into what can be made of it.
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
