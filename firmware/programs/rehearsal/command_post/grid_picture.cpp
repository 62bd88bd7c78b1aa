#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <functional>

#include "rehearsal/command_post/pictures.hpp"

namespace adit::rehearsal {
namespace {

constexpr unsigned char kUnknownCell = 255;

char grey_of(char cell) {
  const auto value = static_cast<unsigned char>(cell);
  if (value == kUnknownCell) return static_cast<char>(205);
  if (value > 100) return static_cast<char>(255);  // no value of the ICD's
  return static_cast<char>(254 - (254 * value + 50) / 100);
}

/// The fewest digits that give the same double back.
std::string digits(double number) {
  char text[64];
  const auto [end, error] = std::to_chars(std::begin(text), std::end(text), number);
  return std::string(std::begin(text), end);
}

double yaw_of(const Quaternion& q) {
  return std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
}

bool write_pgm(const Grid& grid, const std::string& cells, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  file << "P5\n" << grid.width << ' ' << grid.height << "\n255\n";
  std::string row(grid.width, '\0');
  for (std::size_t y = grid.height; y-- > 0;) {
    const auto first = cells.begin() + static_cast<std::ptrdiff_t>(y * grid.width);
    std::transform(first, first + grid.width, row.begin(), grey_of);
    file.write(row.data(), static_cast<std::streamsize>(row.size()));
  }
  file.close();
  return !file.fail();
}

}  // namespace

bool write_grid_picture(const Grid& grid, const std::string& cells, const std::string& stem) {
  if (!write_pgm(grid, cells, stem + ".pgm")) return false;
  std::ofstream file(stem + ".yaml");
  const Point& at = grid.origin.position;
  file << "image: " << stem.substr(stem.rfind('/') + 1) << ".pgm\n"
       << "resolution: " << digits(grid.resolution) << "\n"
       << "origin: [" << digits(at.x) << ", " << digits(at.y) << ", "
       << digits(yaw_of(grid.origin.orientation)) << "]\n"
       << "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
  file.close();
  return !file.fail();
}

std::string tame(std::string_view text) {
  constexpr std::size_t longest = 32;
  std::string tamed(text.substr(0, longest));
  std::ranges::replace_if(tamed, std::not_fn(is_word_character), '_');
  return tamed;
}

}  // namespace adit::rehearsal
