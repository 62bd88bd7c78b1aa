#include "rehearsal/robots/maps/map_file.hpp"

#include <algorithm>
#include <optional>

#include "rehearsal/robots/maps/bytes.hpp"
#include "rehearsal/robots/maps/map_yaml.hpp"
#include "rehearsal/robots/maps/pcd.hpp"
#include "rehearsal/robots/maps/pgm.hpp"
#include "rehearsal/robots/maps/ply.hpp"

namespace adit::robots {
namespace {

namespace fs = std::filesystem;

std::expected<MapYaml, std::string> load_yaml(const fs::path& file) {
  const auto text = read_file(file);
  auto yaml = text ? parse_map_yaml(*text) : std::unexpected(text.error());
  if (!yaml) return std::unexpected(file.filename().string() + ": " + yaml.error());
  return yaml;
}

/// The YAML of the PGM's own name; else one in its folder whose `image` is the PGM; else the defaults.
std::expected<MapYaml, std::string> yaml_beside(const fs::path& pgm) {
  for (const char* ending : {".yaml", ".yml"}) {
    const fs::path file = fs::path(pgm).replace_extension(ending);
    std::error_code error;
    if (fs::exists(file, error)) return load_yaml(file);
  }
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(pgm.parent_path(), error)) {
    if (entry.path().extension() != ".yaml") continue;
    const auto yaml = load_yaml(entry.path());
    if (yaml && fs::path(yaml->image).filename() == pgm.filename()) return yaml;
  }
  return MapYaml{};
}

bool is_map(const fs::path& file) {
  const fs::path ending = file.extension();
  return ending == ".pgm" || ending == ".pcd" || ending == ".ply";
}

std::expected<LoadedMap, std::string> parse(const fs::path& file, std::string_view bytes) {
  if (file.extension() == ".pcd") return parse_pcd(bytes);
  if (file.extension() == ".ply") return parse_ply(bytes);
  const auto yaml = yaml_beside(file);
  if (!yaml) return std::unexpected(yaml.error());
  return parse_pgm(bytes, *yaml);
}

}  // namespace

std::expected<LoadedMap, std::string> load_map(const fs::path& file) {
  if (!is_map(file)) return std::unexpected(file.string() + ": expected a .pgm, .pcd or .ply file");
  const auto bytes = read_file(file);
  if (!bytes) return std::unexpected(file.string() + ": " + bytes.error());
  auto map = parse(file, *bytes);
  if (!map) return std::unexpected(file.string() + ": " + map.error());
  if (const Cloud* cloud = std::get_if<Cloud>(&*map); cloud != nullptr && cloud->data.empty()) {
    return std::unexpected(file.string() + ": the file has no points");
  }
  return map;
}

std::expected<std::vector<fs::path>, std::string> find_maps(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator walk(folder, error);
  for (; !error && walk != fs::recursive_directory_iterator(); walk.increment(error)) {
    std::error_code unreadable;
    if (walk->is_regular_file(unreadable) && is_map(walk->path())) files.push_back(walk->path());
  }
  if (error) return std::unexpected(folder.string() + ": " + error.message());
  std::ranges::sort(files);
  return files;
}

}  // namespace adit::robots
