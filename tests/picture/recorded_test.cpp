#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "picture/maps.hpp"

namespace adit::picture {
namespace {

namespace fs = std::filesystem;

/// The directory of the recorded maps.
fs::path folder() {
  const char* const named = std::getenv("ADIT_MAPS");
  return named == nullptr ? "" : named;
}

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A PGM as map_saver writes it, at the origin, with cells of `resolution`.
icd::MapUpdate recorded_grid(const fs::path& path, double resolution) {
  const std::string bytes = content(path);
  std::istringstream words(bytes);
  std::string word;
  std::vector<std::string> head;
  while (head.size() < 4 && words >> word) {
    if (word.starts_with('#')) {
      std::getline(words, word);
    } else {
      head.push_back(word);
    }
  }
  const auto begin = static_cast<std::size_t>(words.tellg()) + 1;
  const std::size_t width = std::stoul(head.at(1)), height = std::stoul(head.at(2));
  Cells cells;
  for (std::size_t row = height; row-- > 0;) {
    for (std::size_t column = 0; column < width; ++column) {
      const auto grey = static_cast<std::uint8_t>(bytes.at(begin + row * width + column));
      cells.push_back(grey == 0 ? 100 : grey == 254 ? 0 : kUnknown);
    }
  }
  return gzipped(grid_at(0, 0, static_cast<std::uint32_t>(width), resolution, cells));
}

class Recorded : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(folder())) GTEST_SKIP() << "ADIT_MAPS names no folder of recorded maps";
  }
  Easel easel;
};

TEST_F(Recorded, GridHasExactlyTheKnownCellsAsPixels) {
  const auto map = recorded_grid(folder() / "grids/ecn_batS.pgm", 0.02);
  const auto& grid = std::get<icd::OccupancyGrid>(map.msg);
  ASSERT_EQ(grid.width, 1598U);
  const auto drawing = easel.draw(map);
  EXPECT_EQ(drawing.left_out, 0U);
  Cells cells;
  ASSERT_TRUE(codec::gunzip(map.data.bytes, map.data.raw_size, "", [&](auto piece) {
    cells.insert(cells.end(), piece.begin(), piece.end());
    return icd::Checked<void>{};
  }));
  std::map<std::pair<int, int>, int> expected;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] > 100) continue;
    const double x = (static_cast<double>(i % grid.width) + 0.5) * 0.02;
    const double y = (static_cast<double>(i / grid.width) + 0.5) * 0.02;
    int& highest = expected[{static_cast<int>(x / 0.25), static_cast<int>(y / 0.25)}];
    highest = std::max(highest, cells[i] + 1);
  }
  ASSERT_GT(expected.size(), 1000U);
  for (const auto& [at, index] : expected) ASSERT_EQ(easel.pixel(0, at.first, at.second), index);
}

TEST_F(Recorded, ScanHasTheSizeAndHeightsOfARoom) {
  const std::string bytes = content(folder() / "clouds/fast_gicp_251370668.pcd");
  const auto begin = bytes.find("DATA binary\n") + 12;
  icd::PointCloud2 cloud;
  cloud.fields = {{"x", 0, icd::Datatype::Float32, 1},
                  {"y", 4, icd::Datatype::Float32, 1},
                  {"z", 8, icd::Datatype::Float32, 1}};
  cloud.point_step = 16;
  const auto drawing = easel.draw(
      with_data({{}, cloud, {}}, {bytes.begin() + static_cast<std::ptrdiff_t>(begin), bytes.end()}));
  EXPECT_EQ(drawing.left_out, 0U);
  ASSERT_TRUE(drawing.heights && drawing.area);
  EXPECT_GT(drawing.heights->low, -5);
  EXPECT_LT(drawing.heights->high, 15);
  EXPECT_GT(drawing.area->right - drawing.area->left, 20);
  EXPECT_LT(drawing.area->right - drawing.area->left, 300);
}

}  // namespace
}  // namespace adit::picture
