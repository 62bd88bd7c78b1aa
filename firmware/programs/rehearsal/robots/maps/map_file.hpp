#pragma once

#include <expected>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// A Point Cloud Library file, version 0.7, `DATA ascii` or `DATA binary`. Its VIEWPOINT becomes the cloud's
/// origin, as pcl_viewer takes it, unless it is the identity. Points that are NaN are left out.
std::expected<Cloud, std::string> parse_pcd(std::string_view bytes);

/// A PLY file's vertices, its first element; others are left out. `ascii` or `binary_little_endian`.
std::expected<Cloud, std::string> parse_ply(std::string_view bytes);

/// What map_saver writes beside a PGM. The defaults are those of a PGM without one.
struct MapYaml {
  std::string image;
  double resolution = 0.05;  // metres a cell
  double x = 0, y = 0, yaw = 0;
  bool negate = false;
  double occupied_thresh = 0.65;
  double free_thresh = 0.196;
};

/// map_saver's YAML: flat `key: value` lines with `resolution` and `origin`. The error names the key.
std::expected<MapYaml, std::string> parse_map_yaml(std::string_view text);

/// A binary PGM (P5, one byte a cell) as map_server reads it: dark is occupied (100), light is free (0), in
/// between is unknown; the first row is the top of the map, and so the last of the grid.
std::expected<Grid, std::string> parse_pgm(std::string_view bytes, const MapYaml& yaml);

using LoadedMap = std::variant<Grid, Cloud>;

/// Reads a map by its ending: .pgm (with the .yaml that map_saver writes beside it), .pcd or .ply. The error
/// names the file and says what in it is wrong. Files over 256 MiB are refused.
std::expected<LoadedMap, std::string> load_map(const std::filesystem::path& file);

/// The .pgm, .pcd and .ply files under `folder`, at any depth, in the order of their names.
std::expected<std::vector<std::filesystem::path>, std::string> find_maps(const std::filesystem::path& folder);

}  // namespace adit::robots
