#include "rehearsal/robots/map_maker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

namespace adit::robots {
namespace {

constexpr std::size_t kNewPoints = 50;  // at least, in each whole cloud: so that each is news

/// So many cells to each side of one that a grid of the whole cave has about `bytes`.
std::uint32_t finer_by(const Lattice& lattice, std::size_t bytes) {
  const double ratio = static_cast<double>(bytes) / static_cast<double>(lattice.size());
  return static_cast<std::uint32_t>(std::max(1.0, std::round(std::sqrt(ratio))));
}

/// The same grid with `times` x `times` cells for each.
Grid finer(const Grid& grid, std::uint32_t times) {
  Grid fine = grid;
  fine.resolution = grid.resolution / times;
  fine.width = grid.width * times;
  fine.height = grid.height * times;
  fine.cells.resize(std::size_t{fine.width} * fine.height);
  for (std::size_t y = 0; y < fine.height; ++y) {
    const std::uint8_t* const row = &grid.cells[y / times * grid.width];
    for (std::size_t x = 0; x < fine.width; ++x) fine.cells[y * fine.width + x] = row[x / times];
  }
  return fine;
}

/// How many cells are as long as so many metres.
int cells_of(double metres, const Lattice& lattice) {
  return static_cast<int>(std::lround(metres / lattice.resolution));
}

}  // namespace

Grid MapMaker::window(const RobotMap& map, const Vector3& here, double stamp) const {
  const int side = cells_of(kWindow, map.lattice());
  const Cell at = map.lattice().cell_at(here.x, here.y), low{at.x - side / 2, at.y - side / 2};
  return map.part(low, {low.x + side - 1, low.y + side - 1}, stamp);
}

Grid MapMaker::next_tile(const RobotMap& map, double stamp) {
  const int side = cells_of(kTile, map.lattice());
  const Cell first{map.low().x / side, map.low().y / side}, last{map.high().x / side, map.high().y / side};
  const int columns = last.x - first.x + 1, rows = last.y - first.y + 1;
  const int turn = tile_++ % (columns * rows);
  const Cell low{(first.x + turn % columns) * side, (first.y + turn / columns) * side};
  return map.part(low, {low.x + side - 1, low.y + side - 1}, stamp);
}

/// Each of the next frames is another one of eight.
void MapMaker::move_frame(Grid& grid) {
  const int frame = frame_++;
  const auto part = [frame](int bit) { return (frame & bit) == 0 ? 0.0 : 1.0; };
  grid.origin.position.x += kDrift * part(1);
  grid.origin.position.y += kDrift * part(2);
  grid.origin.position.z += kRise * part(4);
  grid.origin.orientation = rotation_of(kYaw * part(1));
}

std::optional<Grid> MapMaker::grid(const RobotMap& map, const Vector3& here, const MapTime& time) {
  if (offer_.grids == GridForm::None) return std::nullopt;
  Grid grid = offer_.grids == GridForm::Rolling ? window(map, here, time.stamp)
              : offer_.grids == GridForm::Tiles ? next_tile(map, time.stamp)
                                                : map.grid(time.stamp);
  if (const std::uint32_t times = finer_by(map.lattice(), offer_.grid_bytes); times > 1)
    grid = finer(grid, times);
  if (offer_.grids == GridForm::Drifting) move_frame(grid);
  date(grid, time.posted);
  cells_.add(grid.resolution, grid.origin.position.x, grid.origin.position.y, grid.width, grid.cells);
  return grid;
}

/// Adds points about the robot, as a denser lidar would measure them, until there are so many bytes.
void MapMaker::fill(Cloud& cloud, std::size_t bytes, const Vector3& here) {
  constexpr double range = 12, height = 3;  // metres
  while (cloud.data.size() < bytes) {
    const double angle = random_.between(0, 2 * std::numbers::pi), far = random_.between(1, range);
    const std::array<float, 4> point = {static_cast<float>(here.x + far * std::cos(angle)),
                                        static_cast<float>(here.y + far * std::sin(angle)),
                                        static_cast<float>(here.z + random_.between(0, height)),
                                        static_cast<float>(random_.below(100))};
    const std::size_t at = cloud.data.size();
    cloud.data.resize(at + sizeof point);
    std::memcpy(&cloud.data[at], point.data(), sizeof point);
  }
}

std::optional<Cloud> MapMaker::cloud(RobotMap& map, const Vector3& here, const MapTime& time) {
  if (offer_.clouds == CloudForm::None) return std::nullopt;
  Cloud news = map.take_new_points(time.stamp);
  const bool whole = offer_.clouds == CloudForm::Whole;
  const std::size_t wanted = offer_.cloud_bytes / (news.point_step + sizeof(std::uint32_t)) * news.point_step;
  const bool is_first = all_.data.empty();
  fill(news, whole && !is_first ? kNewPoints * news.point_step : wanted, here);
  if (news.data.empty()) return std::nullopt;
  date(news, time.posted);
  points_ += news.data.size() / news.point_step;
  places_.add(news.fields, news.point_step, news.data);
  if (!whole) return news;
  news.data.insert(news.data.begin(), all_.data.begin(), all_.data.end());
  all_ = std::move(news);
  return all_;
}

}  // namespace adit::robots
