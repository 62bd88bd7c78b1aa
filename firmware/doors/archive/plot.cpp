#include "archive/plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "icd/require.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::archive {

std::string to_fixed(double number, int digits) {
  char text[64];
  constexpr double kMost = 1e15;
  if (!std::isfinite(number)) return "-";
  const int size = std::snprintf(text, sizeof text, "%.*f", digits, std::clamp(number, -kMost, kMost));
  return {text, static_cast<std::size_t>(std::clamp(size, 0, 63))};
}

std::string duration_text(double seconds) {
  if (!(seconds > 0) || seconds > 1e9) return "-";
  const auto whole = static_cast<long>(seconds);
  char text[48];
  const int size =
      std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  return {text, static_cast<std::size_t>(std::clamp(size, 0, 47))};
}

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
    if (!icd::begins_character(byte)) continue;
    const bool is_ascii = static_cast<std::uint8_t>(byte) < 0x80;
    const bool is_wide = std::string_view("mwMW@%").find(byte) != std::string_view::npos;
    width += !is_ascii || is_wide ? 1.05 : byte >= 'A' && byte <= 'Z' ? 0.75 : 0.65;
  }
  return width * font_size;
}

std::string shorten(std::string_view text, std::size_t most) {
  std::size_t characters = 0, end = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!icd::begins_character(text[i])) continue;
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

namespace {

constexpr Box kAround{14, 6, 4, 9};  // the axes, in millimetres
constexpr double kFinest = 0.1;      // millimetres between two points

std::string line(double x1, double y1, double x2, double y2, const char* kind) {
  return icd::sentence("<path class=\"", kind, "\" d=\"M", to_fixed(x1, 2), " ", to_fixed(y1, 2), "L",
                       to_fixed(x2, 2), " ", to_fixed(y2, 2), "\"/>");
}

std::string text(double x, double y, const char* anchor, const std::string& words) {
  return icd::sentence("<text x=\"", to_fixed(x, 2), "\" y=\"", to_fixed(y, 2), "\" text-anchor=\"", anchor,
                       "\">", icd::escape_html(words), "</text>");
}

/// The axes' scales: to millimetres.
struct Scales {
  double first = 0, minutes = 1, most = 1;  // at the left; to the right end; at the top
  double right = 0, bottom = 0;

  double x(double at) const { return kAround.left + (at - first) / minutes * (right - kAround.left); }
  double y(double value) const { return bottom - std::min(value / most, 1.0) * (bottom - kAround.top); }
};

std::string path_of(const Plot& plot, const Scales& scales) {
  std::string path;
  bool is_in_gap = true;
  double last_x = 0, last_y = 0;
  const auto go_to = [&](double x, double y) {
    path += is_in_gap ? 'M' : 'L';
    path += to_fixed(x, 2) + ' ' + to_fixed(y, 2);
    is_in_gap = false;
    last_x = x, last_y = y;
  };
  for (std::size_t i = 0; i < plot.minutes.size();) {
    const double x = scales.x(plot.minutes[i]);
    std::optional<double> highest;
    for (; i < plot.minutes.size() && scales.x(plot.minutes[i]) < x + kFinest; ++i) {
      if (plot.values[i]) highest = std::max(highest.value_or(0), *plot.values[i]);
    }
    if (!highest) {
      is_in_gap = true;
      continue;
    }
    const double y = scales.y(*highest);
    if (plot.is_held && !is_in_gap) go_to(x, last_y);
    go_to(x, y);
  }
  if (plot.is_held && !is_in_gap && last_x < scales.right) go_to(scales.right, last_y);
  return path;
}

}  // namespace

std::string draw_plot(const Plot& plot) {
  icd::require(plot.minutes.size() == plot.values.size());
  double most = 0;
  bool any = false;
  for (const auto& value : plot.values) {
    any = any || value;
    most = std::max(most, value.value_or(0));
  }
  if (!any) return "";
  Scales scales{.first = std::min(0.0, plot.minutes.front()),
                .right = plot.width - kAround.right,
                .bottom = plot.height - kAround.bottom};
  scales.minutes = std::max(plot.minutes.back() - scales.first, 1.0);
  const auto rows = ticks(0, most > 0 ? most * 1.05 : 1, static_cast<int>(plot.height / 9));
  scales.most = std::max(most > 0 ? most * 1.05 : 1, rows.empty() ? 0 : rows.back());
  const auto columns = ticks(scales.first, scales.first + scales.minutes, static_cast<int>(plot.width / 18));
  std::string all;
  for (const double value : rows) {
    all += line(kAround.left, scales.y(value), scales.right, scales.y(value), "grid");
    all += text(kAround.left - 1.5, scales.y(value) + 1, "end", to_fixed(value, decimals_of(rows)));
  }
  for (const double minute : columns) {
    all += line(scales.x(minute), scales.bottom, scales.x(minute), scales.bottom + 1.2, "axis");
    all += text(scales.x(minute), scales.bottom + 4.4, "middle", to_fixed(minute, decimals_of(columns)));
  }
  all += line(kAround.left, scales.bottom, scales.right, scales.bottom, "axis") +
         line(kAround.left, kAround.top, kAround.left, scales.bottom, "axis") +
         text(0, 3, "start", plot.name) + text(scales.right, scales.bottom + 8, "end", "minutes of the run");
  return icd::sentence("<figure style=\"width:", to_fixed(plot.width, 0),
                       "mm\"><svg role=\"img\" aria-label=\"", icd::escape_html(plot.name),
                       "\" viewBox=\"0 0 ", to_fixed(plot.width, 0), " ", to_fixed(plot.height, 0), "\">",
                       all, "<path class=\"curve\" d=\"", path_of(plot, scales), "\"/></svg></figure>\n");
}

}  // namespace adit::archive
