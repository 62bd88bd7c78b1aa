#pragma once

#include <optional>
#include <string>
#include <vector>

namespace adit::archive {

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
std::string drawn(const Plot& plot);

}  // namespace adit::archive
