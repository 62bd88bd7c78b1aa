#pragma once

#include <string>

#include "panel/panel.hpp"
#include "panel/states.hpp"

namespace adit::panel {

/// The README's picture: the light of each pattern over four seconds. The row of digits shows the beginning
/// of an address.
inline std::string drawing() {
  constexpr int kLeft = 70, kTop = 26, kRow = 30, kHigh = 16, kSecond = 160, kSeconds = 4;
  const auto text = [](int x, int y, const std::string& words, const char* anchor) {
    return "<text x=\"" + std::to_string(x) + "\" y=\"" + std::to_string(y) + "\" text-anchor=\"" + anchor +
           "\">" + words + "</text>\n";
  };
  const int rows = static_cast<int>(kPatterns.size());
  const std::string width = std::to_string(kLeft + kSeconds * kSecond + 20),
                    height = std::to_string(kTop + rows * kRow + 6);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + width + " " + height +
                    "\" font-family=\"sans-serif\" font-size=\"13\">\n"
                    "<title>When a light of each pattern is lit, over four seconds</title>\n"
                    "<rect width=\"" +
                    width + "\" height=\"" + height + "\" fill=\"#fff\"/>\n";
  for (int second = 0; second <= kSeconds; ++second) {
    const int x = kLeft + second * kSecond;
    svg += text(x, 14, std::to_string(second) + " s", "middle");
    svg += "<path d=\"M" + std::to_string(x) + " 20V" + height + "\" stroke=\"#ccc\"/>\n";
  }
  for (int row = 0; row < rows; ++row) {
    const Pattern pattern = kPatterns[static_cast<std::size_t>(row)];
    const int top = kTop + row * kRow;
    svg += text(kLeft - 10, top + 13, std::string(name_of(pattern)), "end");
    const std::vector<Step> digits = address_digits("10.0.0.1");
    const auto moment = [&](Milliseconds at) {
      return pattern == Pattern::Digits ? single_moment(digits, at) : repeated_moment(steps_of(pattern), at);
    };
    const Milliseconds end = std::chrono::seconds(kSeconds);
    for (Milliseconds at{}; at < end;) {
      const Moment now = moment(at);
      const Milliseconds next = std::min(end, at + now.lasts.value_or(end));
      const auto x = [&](Milliseconds t) { return kLeft + static_cast<int>(t.count()) * kSecond / 1000; };
      if (now.lit) {
        svg += "<rect x=\"" + std::to_string(x(at)) + "\" y=\"" + std::to_string(top) + "\" width=\"" +
               std::to_string(x(next) - x(at)) + "\" height=\"" + std::to_string(kHigh) +
               "\" fill=\"#b45309\"/>\n";
      }
      at = next;
    }
    svg += "<path d=\"M" + std::to_string(kLeft) + " " + std::to_string(top + kHigh) + "h" +
           std::to_string(kSeconds * kSecond) + "\" stroke=\"#444\"/>\n";
  }
  return svg + "</svg>\n";
}

}  // namespace adit::panel
