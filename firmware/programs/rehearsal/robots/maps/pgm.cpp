#include "rehearsal/robots/maps/pgm.hpp"

#include <algorithm>
#include <array>

#include "rehearsal/robots/maps/bytes.hpp"

namespace adit::robots {
namespace {

/// A PGM header's next word: blanks, line ends and comments go before it.
std::string_view take_word(std::string_view& rest) {
  constexpr std::string_view kBlanks = " \t\r\n";
  while (true) {
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
    if (!rest.starts_with('#')) break;
    rest.remove_prefix(std::min(rest.find('\n'), rest.size()));
  }
  const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
  rest.remove_prefix(word.size());
  return word;
}

std::expected<std::uint32_t, std::string> take_number(std::string_view& rest, const char* what,
                                                      std::uint32_t most) {
  const std::string_view word = take_word(rest);
  const auto number = parse_number<std::uint32_t>(word);
  if (number && *number >= 1 && *number <= most) return *number;
  return std::unexpected(std::string(what) + ": expected a number from 1 to " + std::to_string(most) +
                         ", got '" + std::string(word.substr(0, 20)) + "'");
}

/// map_server's trinary mode, for each grey.
std::array<std::uint8_t, 256> trinary(std::uint32_t white, const MapYaml& yaml) {
  std::array<std::uint8_t, 256> cells{};
  for (std::uint32_t grey = 0; grey < cells.size(); ++grey) {
    const double light = static_cast<double>(std::min(grey, white)) / white;
    const double occupancy = yaml.negate ? light : 1 - light;
    cells[grey] = occupancy > yaml.occupied_thresh ? 100 : occupancy < yaml.free_thresh ? 0 : kUnknown;
  }
  return cells;
}

}  // namespace

std::expected<Grid, std::string> parse_pgm(std::string_view bytes, const MapYaml& yaml) {
  constexpr std::uint32_t kLongestSide = 100'000;
  std::string_view rest = bytes;
  if (const std::string_view magic = take_word(rest); magic != "P5") {
    return std::unexpected("expected a binary PGM (P5), got '" + std::string(magic.substr(0, 20)) + "'");
  }
  const auto width = take_number(rest, "width", kLongestSide);
  if (!width) return std::unexpected(width.error());
  const auto height = take_number(rest, "height", kLongestSide);
  if (!height) return std::unexpected(height.error());
  const auto white = take_number(rest, "largest grey", 255);
  if (!white) return std::unexpected(white.error());
  rest.remove_prefix(std::min<std::size_t>(1, rest.size()));  // exactly one blank ends the header

  const std::size_t size = std::size_t{*width} * *height;
  if (rest.size() < size) {
    return std::unexpected("expected " + std::to_string(*width) + " x " + std::to_string(*height) + " = " +
                           std::to_string(size) + " cells, got " + std::to_string(rest.size()));
  }
  Grid grid;
  grid.resolution = yaml.resolution;
  grid.width = *width;
  grid.height = *height;
  grid.origin = {.position = {yaml.x, yaml.y, 0}, .orientation = rotation_of(yaml.yaw)};
  grid.cells.reserve(size);
  const auto cells = trinary(*white, yaml);
  for (std::size_t row = *height; row-- > 0;) {
    for (const char grey : rest.substr(row * *width, *width))
      grid.cells.push_back(cells[static_cast<std::uint8_t>(grey)]);
  }
  return grid;
}

}  // namespace adit::robots
