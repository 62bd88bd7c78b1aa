#include "sizes_maps.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>
#include <variant>

#include "pack/grids.hpp"
#include "rehearsal/robots/maps/map_file.hpp"

namespace adit::bench {
namespace {

namespace fs = std::filesystem;

SizedMap map_of(const pack::Grid& grid) {
  const std::string size = std::to_string(grid.width) + " x " + std::to_string(grid.height);
  return {grid.what + ", " + size, grid.update()};
}

SizedMap map_of(const std::string& name, robots::Grid loaded) {
  pack::Grid grid(name, loaded.width, loaded.height);
  grid.cells = std::move(loaded.cells);
  return map_of(grid);
}

SizedMap map_of(const std::string& name, const robots::Cloud& loaded) {
  icd::PointCloud2 cloud;
  for (const CloudField& field : loaded.fields) {
    cloud.fields.push_back(
        {field.name, field.offset, static_cast<icd::Datatype>(field.datatype), field.count});
  }
  cloud.point_step = loaded.point_step;
  return {name, {{}, cloud, {icd::ChunkedBytes(loaded.data), icd::Compression::None, loaded.data.size()}}};
}

/// Grey 0 to 255 is cost 0 to 100; the rows as they come.
std::expected<SizedMap, std::string> cost_map(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::istringstream words(bytes);
  std::vector<std::size_t> head;
  std::string word;
  words >> word;
  while (head.size() < 3 && words >> word) {
    if (word.starts_with('#')) {
      std::getline(words, word);
    } else {
      head.push_back(std::stoul(word));
    }
  }
  const auto begin = static_cast<std::size_t>(words.tellg()) + 1;
  if (head.size() < 3 || bytes.size() != begin + head[0] * head[1]) {
    return std::unexpected(path.string() + ": no PGM of one byte a cell");
  }
  pack::Grid grid(path.stem().string(), head[0], head[1]);
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    grid.cells[i] = static_cast<std::uint8_t>(static_cast<std::uint8_t>(bytes[begin + i]) * 100 / 255);
  }
  return map_of(grid);
}

std::expected<SizedMap, std::string> recorded_map(const fs::path& path) {
  if (path.extension() == ".pgm" && !fs::exists(fs::path(path).replace_extension(".yaml")))
    return cost_map(path);
  auto loaded = robots::load_map(path);
  if (!loaded) return std::unexpected(loaded.error());
  return std::visit([&](auto& map) { return map_of(path.stem().string(), std::move(map)); }, *loaded);
}

}  // namespace

std::expected<std::vector<SizedMap>, std::string> recorded_maps(const std::string& folder) {
  std::vector<SizedMap> maps;
  if (!fs::exists(folder)) return maps;
  const auto files = robots::find_maps(folder);
  if (!files) return std::unexpected(files.error());
  for (const fs::path& file : *files) {
    auto map = recorded_map(file);
    if (!map) return std::unexpected(map.error());
    maps.push_back(*std::move(map));
  }
  return maps;
}

std::vector<SizedMap> generated_grids(bool is_short, std::uint64_t seed) {
  using pack::cave;
  using pack::Grid;
  std::vector<Grid> grids{cave(1500, 1500, seed + 1),
                          graded(cave(1000, 1000, seed + 2)),
                          speckled(cave(1500, 1500, seed + 3)),
                          measured(cave(1000, 1000, seed + 4)),
                          pack::noise(600, 600, 101),
                          pack::noise(600, 600, 2),
                          cave(200, 200, seed + 5),
                          Grid("few cells", 20, 20)};
  if (!is_short) {
    grids.push_back(cave(5000, 5000, seed + 6));
    grids.push_back(cave(40'000, 400, seed + 7));
    grids.push_back(Grid("all unknown", 5000, 5000));
    for (const bool is_row : {true, false}) {
      Grid line = cave(1000, 1000, seed + 8);
      line.what = is_row ? "one row" : "one column";
      line.width = is_row ? line.cells.size() : 1;
      line.height = is_row ? 1 : line.cells.size();
      grids.push_back(std::move(line));
    }
  }
  std::vector<SizedMap> maps;
  for (const Grid& grid : grids) maps.push_back(map_of(grid));
  return maps;
}

}  // namespace adit::bench
