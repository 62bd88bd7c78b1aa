#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace adit::archive {

/// The number with `digits` decimals.
std::string to_fixed(double number, int digits);

/// "1:02:03", or "-" for no time.
std::string duration_text(double seconds);

/// A rectangle on paper, in millimetres; y grows downwards.
struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;

  /// True if they have more than a border in common.
  bool overlaps(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
  bool contains(const Box& other) const {
    return left <= other.left && other.right <= right && top <= other.top && other.bottom <= bottom;
  }
};

/// Finds places for labels, so that no label covers a sign, another label or the frame's border.
class Labels {
 public:
  explicit Labels(const Box& frame) : frame_(frame) {}

  /// No label will cover this.
  void keep_free(const Box& taken) { taken_.push_back(taken); }
  /// A free place by a sign of this radius at (x, y): right, left, above, below, then farther; nullopt: none.
  std::optional<Box> place(double x, double y, double radius, double width, double height);

 private:
  bool is_free(const Box& box) const;

  Box frame_;
  std::vector<Box> taken_;
};

/// At least the width of a text in a usual font without serifs, by the font's size.
double width_of(std::string_view text, double font_size);

/// A text of at most `most` characters: the beginning and an ellipsis if it is longer. `text` is UTF-8.
std::string shorten(std::string_view text, std::size_t most);

/// Multiples of 1, 2 or 5 times a power of ten from `low` to `high`: at most `most` + 1. Empty unless `low`
/// is below `high` and both are finite.
std::vector<double> ticks(double low, double high, int most);
/// The decimals that tell two of these ticks apart.
int decimals_of(const std::vector<double>& ticks);

/// A plot over time for print, with axes and ticks.
struct Plot {
  std::string name;                                // "Covered area (m²)": with the unit
  std::vector<double> minutes = {};                // of the run, ascending
  std::vector<std::optional<double>> values = {};  // one for each, not negative; nullopt: a gap
  bool is_held = false;                            // each value holds until the next one
  double width = 180, height = 60;                 // millimetres
};

/// A figure with an svg element, or "" without a value. Of values that lie closer than a tenth of a
/// millimetre, the highest is drawn.
std::string draw_plot(const Plot& plot);

}  // namespace adit::archive
