#pragma once

#include <expected>
#include <string>
#include <string_view>

namespace adit::robots {

/// What map_saver writes beside a PGM. The defaults are those of a PGM without one.
struct MapYaml {
  std::string image;
  double resolution = 0.05;  // metres a cell
  double x = 0, y = 0, yaw = 0;
  bool negate = false;
  double occupied_thresh = 0.65;
  double free_thresh = 0.196;
};

/// The YAML of a map_saver: flat `key: value` lines. `resolution` and `origin` must be there; the error names
/// the key.
std::expected<MapYaml, std::string> parse_map_yaml(std::string_view text);

}  // namespace adit::robots
