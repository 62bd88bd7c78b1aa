#include "archive/labels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace adit::archive {
namespace {

bool begins_character(char byte) {
  return (static_cast<std::uint8_t>(byte) & 0xC0) != 0x80;
}

}  // namespace

bool Labels::is_free(const Box& box) const {
  return frame_.contains(box) &&
         std::ranges::none_of(taken_, [&](const Box& each) { return each.overlaps(box); });
}

std::optional<Box> Labels::place(double x, double y, double radius, double width, double height) {
  constexpr double kDistances[] = {0.9, 3, 6, 9};  // from the sign
  constexpr double kSides[][2] = {{1, 0}, {-1, 0}, {0, -1}, {0, 1}, {1, -1}, {-1, -1}, {1, 1}, {-1, 1}};
  for (const double distance : kDistances) {
    for (const auto& [across, down] : kSides) {
      const double away = (radius + distance) * (across != 0 && down != 0 ? M_SQRT1_2 : 1);
      const double left = x + across * away + (across - 1) * width / 2,
                   top = y + down * away + (down - 1) * height / 2;
      const Box box{left, top, left + width, top + height};
      if (!is_free(box)) continue;
      taken_.push_back(box);
      return box;
    }
  }
  return std::nullopt;
}

double width_of(std::string_view text, double font_size) {
  double width = 0;
  for (const char byte : text) {
    if (!begins_character(byte)) continue;
    const bool is_ascii = static_cast<std::uint8_t>(byte) < 0x80;
    const bool is_wide = std::string_view("mwMW@%").find(byte) != std::string_view::npos;
    width += !is_ascii || is_wide ? 1.05 : byte >= 'A' && byte <= 'Z' ? 0.75 : 0.65;
  }
  return width * font_size;
}

std::string shortened(std::string_view text, std::size_t most) {
  std::size_t characters = 0, end = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!begins_character(text[i])) continue;
    if (++characters == most) end = i;  // the ellipsis is the last one
    if (characters > most) return std::string(text.substr(0, end)) + "\u2026";
  }
  return std::string(text);
}

std::vector<double> ticks(double low, double high, int most) {
  const double span = high - low;
  if (!(span > 0) || !std::isfinite(span) || most < 1) return {};
  const double least = span / most, power = std::pow(10, std::floor(std::log10(least)));
  double step = 10 * power;
  for (const double each : {5 * power, 2 * power, power}) {
    if (each >= least * (1 - 1e-9)) step = each;
  }
  const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
  const int more = static_cast<int>(std::clamp(last - first, -1.0, static_cast<double>(most)));
  std::vector<double> all;
  for (int i = 0; i <= more; ++i) all.push_back((first + i) * step + 0.0);
  return all;
}

int decimals_of(const std::vector<double>& ticks) {
  if (ticks.size() < 2) return 0;
  return static_cast<int>(std::clamp(std::ceil(-std::log10(ticks[1] - ticks[0]) - 1e-9), 0.0, 9.0));
}

}  // namespace adit::archive
