#pragma once

#include <charconv>
#include <cstdint>
#include <expected>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// A file's whole text, up to 256 MiB.
std::expected<std::string, std::string> read_file(const std::filesystem::path& file);

/// Takes the next line off `rest`, without its \n or \r\n. Nothing at the end.
std::optional<std::string_view> take_line(std::string_view& rest);

/// The words of a line, split at blanks.
std::vector<std::string_view> words_of(std::string_view line);

/// All of `text` as one number, and nothing else.
template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// A file's points: fields one after another, in the file's order. What PCD and PLY have in common.
class PointTable {
 public:
  /// Adds `count` values of the ICD's `datatype`. A name of "_" is padding.
  void add_field(std::string name, int datatype, std::uint32_t count);

  /// Whether x, y and z are there, each once and single, all float32 or all float64 (what the ICD and the
  /// Command Posts take), and no field twice.
  std::expected<void, std::string> check() const;

  std::uint32_t point_step() const { return step_; }

  /// `points` points from the start of `bytes`, little endian.
  std::expected<Cloud, std::string> from_binary(std::string_view bytes, std::uint64_t points) const;
  /// One point a line; `first_line` numbers the lines of errors.
  std::expected<Cloud, std::string> from_ascii(std::string_view text, std::uint64_t points,
                                               std::size_t first_line) const;

 private:
  Cloud cloud_of(const std::vector<std::uint8_t>& bytes) const;
  bool is_finite(const std::uint8_t* point) const;

  std::vector<CloudField> fields_;
  std::uint32_t step_ = 0;
};

/// A Point Cloud Library file, version 0.7, `DATA ascii` or `DATA binary`. Its VIEWPOINT becomes the cloud's
/// origin, as pcl_viewer takes it, unless it is the identity. Points that are NaN are left out.
std::expected<Cloud, std::string> parse_pcd(std::string_view bytes);

/// The vertices of a PLY file, `ascii` or `binary_little_endian`; they must be its first element. Other
/// elements are left out.
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

/// The YAML of a map_saver: flat `key: value` lines. `resolution` and `origin` must be there; the error names
/// the key.
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
