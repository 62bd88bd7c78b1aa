#include "rehearsal/robots/robot.hpp"

#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <utility>

#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::robots {

namespace {

constexpr double kRange = 12;  // metres
constexpr int kRays = 540;
constexpr double kPointNoise = 0.015;  // metres
constexpr std::size_t kValues = 4;     // of a point
static_assert(std::endian::native == std::endian::little, "clouds are sent little endian");

/// A cell's value after one more look: free cells sink from 45 to 0, rock rises from 55 to 100.
std::uint8_t updated_cell(std::uint8_t value, bool rock) {
  constexpr int kFirst = 5, kStep = 15;
  const int before = value == kUnknown ? 50 : value;
  const int step = value == kUnknown ? kFirst : kStep;
  return static_cast<std::uint8_t>(std::clamp(before + (rock ? step : -step), 0, 100));
}

constexpr std::array<Cell, 8> kSteps = {Cell{1, 0}, Cell{0, 1},  Cell{-1, 0},  Cell{0, -1},
                                        Cell{1, 1}, Cell{-1, 1}, Cell{-1, -1}, Cell{1, -1}};

/// Breadth first: the cells in order of their distance, and from where each was reached.
struct Reach {
  std::vector<Cell> cells;
  Raster<int> steps;    // from the start; -1: not reached
  Raster<int> reached;  // index in kSteps of the step that led there
};

Reach reach_from(const RobotMap& map, Cell start) {
  Reach reach{.cells = {start}, .steps = {map.lattice(), -1}, .reached = {map.lattice(), 0}};
  reach.steps[start] = 0;
  for (std::size_t next = 0; next < reach.cells.size(); ++next) {
    const Cell cell = reach.cells[next];
    // Rock that was seen later may surround the robot; then it leaves over any free cell.
    const bool squeezed = !is_walkable(map, cell);
    for (std::size_t step = 0; step < kSteps.size(); ++step) {
      const Cell beside{cell.x + kSteps[step].x, cell.y + kSteps[step].y};
      if (!map.lattice().contains(beside) || reach.steps[beside] >= 0) continue;
      if (!is_walkable(map, beside) && !(squeezed && map.is_free(beside))) continue;
      reach.steps[beside] = reach.steps[cell] + 1;
      reach.reached[beside] = static_cast<int>(step);
      reach.cells.push_back(beside);
    }
  }
  return reach;
}

/// Metres to walk, and up to kDetour more for a place that lies the wrong way.
double cost(const Lattice& lattice, Cell start, Cell goal, int steps, double heading) {
  constexpr double kDetour = 12;
  const double direction = std::atan2(goal.y - start.y, goal.x - start.x);
  return steps * lattice.resolution + kDetour * (1 - std::cos(direction - heading)) / 2;
}

using Seconds = std::chrono::duration<double>;

constexpr double kMegabyte = 1e6;
constexpr std::array<double, 3> kCloudEvery = {1, 0.5, 2};  // seconds, of one robot after the other

constexpr std::array<std::pair<std::string_view, GridForm>, 5> kGridForms = {
    {{"whole", GridForm::Whole},
     {"drifting", GridForm::Drifting},
     {"rolling", GridForm::Rolling},
     {"tiles", GridForm::Tiles},
     {"none", GridForm::None}}};
constexpr std::array<std::pair<std::string_view, CloudForm>, 3> kCloudForms = {
    {{"differential", CloudForm::Differential}, {"whole", CloudForm::Whole}, {"none", CloudForm::None}}};

template <class Form, std::size_t N>
std::expected<std::vector<Form>, std::string> parse_forms(
    std::string_view text, const std::array<std::pair<std::string_view, Form>, N>& names) {
  std::vector<Form> forms;
  for (std::string_view rest = text; forms.empty() || !rest.empty();) {
    const auto* const known =
        std::ranges::find(names, icd::cut(rest, ','), &std::pair<std::string_view, Form>::first);
    if (known == names.end()) {
      const std::string all = icd::join_words(names, &std::pair<std::string_view, Form>::first);
      return std::unexpected(icd::sentence("expected ", all, ", got '", text, "'"));
    }
    forms.push_back(known->second);
  }
  return forms;
}

constexpr std::size_t kNewPoints = 50;  // at least, in each whole cloud: so that each is news

/// So many cells to each side of one that a grid of the whole cave has about `bytes`.
std::uint32_t finer_by(const Lattice& lattice, std::size_t bytes) {
  const double ratio = static_cast<double>(bytes) / static_cast<double>(lattice.size());
  return static_cast<std::uint32_t>(std::max(1.0, std::round(std::sqrt(ratio))));
}

/// The same grid with `times` x `times` cells for each.
Grid refine(const Grid& grid, std::uint32_t times) {
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

RobotMap::RobotMap(const Lattice& lattice)
    : cells_(lattice, kUnknown), low_{lattice.width, lattice.height}, high_{-1, -1} {}

void RobotMap::include(Cell cell) {
  low_ = {std::min(low_.x, cell.x), std::min(low_.y, cell.y)};
  high_ = {std::max(high_.x, cell.x), std::max(high_.y, cell.y)};
}

void RobotMap::see_point(double x, double y, double z, double intensity, Random& random) {
  for (const double metres : {x, y, z})
    points_.push_back(static_cast<float>(metres + random.noise(kPointNoise)));
  points_.push_back(static_cast<float>(intensity));
}

void RobotMap::see_floor(const Cave& cave, Cell cell, Random& random) {
  if (!is_known(cell)) {
    const double x = lattice().centre_x(cell), y = lattice().centre_y(cell);
    see_point(x, y, cave.floor_at(cell), 40 + 20 * random.uniform(0, 1), random);
    see_point(x, y, cave.ceiling_at(cell), 25 + 10 * random.uniform(0, 1), random);
    include(cell);
  }
  cells_[cell] = updated_cell(cells_[cell], false);
}

void RobotMap::see_rock(Cell cell, double floor, double ceiling, Random& random) {
  if (!is_known(cell)) {
    const int points = static_cast<int>((ceiling - floor) / lattice().resolution) + 1;
    for (int i = 0; i < points; ++i) {
      const double z = floor + i * lattice().resolution;
      see_point(lattice().centre_x(cell), lattice().centre_y(cell), z, 80 + 40 * random.uniform(0, 1),
                random);
    }
    include(cell);
  }
  cells_[cell] = updated_cell(cells_[cell], true);
}

void RobotMap::sweep(const Cave& cave, const Vector3& from, Random& random) {
  Raster<std::uint8_t> seen(lattice(), 0);  // each cell is looked at once a sweep
  const double step = lattice().resolution / 2;
  for (int ray = 0; ray < kRays; ++ray) {
    const double angle = 2 * std::numbers::pi * ray / kRays;
    const double along_x = std::cos(angle), along_y = std::sin(angle);
    Cell last = lattice().cell_at(from.x, from.y);
    for (int i = 0; i <= static_cast<int>(kRange / step); ++i) {
      const double range = i * step;
      const Cell cell = lattice().cell_at(from.x + range * along_x, from.y + range * along_y);
      if (!lattice().contains(cell)) break;
      const bool rock = !cave.is_open(cell);
      if (std::exchange(seen[cell], std::uint8_t{1}) == 0) {
        if (rock) {
          see_rock(cell, cave.floor_at(last), cave.ceiling_at(last), random);
        } else {
          see_floor(cave, cell, random);
        }
      }
      if (rock) break;
      last = cell;
    }
  }
}

Grid RobotMap::grid(double stamp) const {
  assert(low_.x <= high_.x);
  return part(low_, high_, stamp);
}

Grid RobotMap::part(Cell low, Cell high, double stamp) const {
  Grid grid;
  grid.stamp = stamp;
  grid.resolution = lattice().resolution;
  grid.width = static_cast<std::uint32_t>(high.x - low.x + 1);
  grid.height = static_cast<std::uint32_t>(high.y - low.y + 1);
  grid.origin.position = {lattice().left + low.x * lattice().resolution,
                          lattice().bottom + low.y * lattice().resolution, 0};
  grid.cells.reserve(std::size_t{grid.width} * grid.height);
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) {
      const Cell cell{x, y};
      grid.cells.push_back(lattice().contains(cell) ? cells_[cell] : kUnknown);
    }
  }
  return grid;
}

Cloud RobotMap::take_new_points(double stamp) {
  Cloud cloud;
  cloud.stamp = stamp;
  cloud.fields = {
      {"x", 0, kFloat32, 1}, {"y", 4, kFloat32, 1}, {"z", 8, kFloat32, 1}, {"intensity", 12, kFloat32, 1}};
  cloud.point_step = kValues * sizeof(float);
  cloud.data.resize(points_.size() * sizeof(float));
  if (!points_.empty()) std::memcpy(cloud.data.data(), points_.data(), cloud.data.size());
  points_.clear();
  return cloud;
}

bool is_walkable(const RobotMap& map, Cell cell) {
  return map.is_free(cell) && std::ranges::none_of(kSteps, [&](Cell step) {
           const Cell beside{cell.x + step.x, cell.y + step.y};
           return !map.lattice().contains(beside) || map.is_rock(beside);
         });
}

bool is_frontier(const RobotMap& map, Cell cell) {
  return std::ranges::any_of(kSteps, [&](Cell step) {
    const Cell beside{cell.x + step.x, cell.y + step.y};
    return map.lattice().contains(beside) && !map.is_known(beside);
  });
}

std::vector<Cell> exploration_path(const RobotMap& map, Cell start, double heading, Random& random) {
  const Reach reach = reach_from(map, start);
  Cell goal = start;
  double cheapest = std::numeric_limits<double>::infinity();
  for (const Cell cell : reach.cells) {
    if (!is_frontier(map, cell) || !is_walkable(map, cell)) continue;
    const double price = cost(map.lattice(), start, cell, reach.steps[cell], heading);
    if (price < cheapest) {
      cheapest = price;
      goal = cell;
    }
  }
  if (goal == start) goal = reach.cells[random.uniform_index(reach.cells.size())];
  std::vector<Cell> way;
  for (Cell cell = goal; cell != start;) {
    way.push_back(cell);
    const Cell step = kSteps[static_cast<std::size_t>(reach.reached[cell])];
    cell = {cell.x - step.x, cell.y - step.y};
  }
  std::ranges::reverse(way);
  return way;
}

Robot::Robot(const Cave& cave, std::uint64_t seed, std::size_t index)
    : cave_(cave),
      random_(seed * 1'000'003 + index),
      map_(cave.lattice()),
      x_(0.4 * static_cast<double>(index % 3)),
      y_(0.4 * static_cast<double>(index / 3 % 3)),
      yaw_(0),
      preferred_(std::numbers::pi / 3 * (static_cast<double>((index + 1) % 3) - 1)),
      noticed_(cave.artifacts().size(), false) {
  map_.sweep(cave_, pose().position, random_);
  map_.sweep(cave_, pose().position, random_);
  detect_artifacts();
}

Placement Robot::pose() const {
  const double z = cave_.floor_at(cave_.lattice().cell_at(x_, y_)) + 0.4;
  return {.position = {x_, y_, z}, .orientation = rotation_of(yaw_)};
}

void Robot::step(double metres) {
  const Lattice& lattice = cave_.lattice();
  while (metres > 0) {
    if (way_.empty()) {
      way_ = exploration_path(map_, lattice.cell_at(x_, y_), preferred_, random_);
      std::ranges::reverse(way_);
      if (way_.empty()) return;  // it stands still until it sees a way
    }
    const double dx = lattice.centre_x(way_.back()) - x_, dy = lattice.centre_y(way_.back()) - y_;
    const double far = std::hypot(dx, dy);
    if (far <= metres) {
      x_ += dx;
      y_ += dy;
      way_.pop_back();
    } else {
      x_ += dx / far * metres;
      y_ += dy / far * metres;
    }
    if (far > 1e-9) yaw_ = std::atan2(dy, dx);
    walked_ += std::min(far, metres);
    metres -= far;
  }
}

void Robot::advance(double metres) {
  // Newly seen cells may make the goal pointless. The way stays walkable, because the cave is constant.
  if (!way_.empty() && !is_frontier(map_, way_.front()) && random_.chance(0.2)) way_.clear();
  step(metres);
  map_.sweep(cave_, pose().position, random_);
  detect_artifacts();
}

void Robot::detect_artifacts() {
  const Vector3 here = pose().position;
  for (std::size_t i = 0; i < cave_.artifacts().size(); ++i) {
    const Vector3& there = cave_.artifacts()[i].position;
    if (noticed_[i] || std::hypot(there.x - here.x, there.y - here.y) > kSightRange) continue;
    if (!cave_.can_see(here, there)) continue;
    noticed_[i] = true;
    sightings_.push_back(i);
  }
}

void date(Grid& grid, Moment posted) {
  if (grid.width < kDateFollows.size() + kDateDigits) return;
  auto cell = std::ranges::copy(kDateFollows, grid.cells.begin()).out + kDateDigits;
  std::int64_t rest = posted.time_since_epoch().count();
  for (std::size_t i = 0; i < kDateDigits; ++i, rest /= kDateBase)
    *--cell = static_cast<std::uint8_t>(rest % kDateBase);
}

void date(Cloud& cloud, Moment posted) {
  const std::uint32_t before = cloud.point_step;
  const auto date = static_cast<std::uint32_t>(posted.time_since_epoch().count());
  cloud.fields.push_back({"posted_ms", before, kUint32, 1});
  cloud.point_step += sizeof date;
  std::vector<std::uint8_t> dated(cloud.data.size() / before * cloud.point_step);
  for (std::size_t from = 0, to = 0; to < dated.size(); from += before, to += cloud.point_step) {
    std::memcpy(&dated[to], &cloud.data[from], before);
    std::memcpy(&dated[to + before], &date, sizeof date);
  }
  cloud.data = std::move(dated);
}

MapOffer MapOffers::offer_of(std::size_t robot) const {
  return {.grids = grids[robot % grids.size()],
          .clouds = clouds[robot % clouds.size()],
          .grid_every = Seconds(1 / grid_hz.value_or(1)),
          .cloud_every = Seconds(cloud_hz ? 1 / *cloud_hz : kCloudEvery[robot % kCloudEvery.size()]),
          .grid_bytes = static_cast<std::size_t>(grid_mb * kMegabyte),
          .cloud_bytes = static_cast<std::size_t>(cloud_mb * kMegabyte)};
}

std::expected<std::vector<GridForm>, std::string> parse_grid_forms(std::string_view text) {
  return parse_forms(text, kGridForms);
}

std::expected<std::vector<CloudForm>, std::string> parse_cloud_forms(std::string_view text) {
  return parse_forms(text, kCloudForms);
}

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
    grid = refine(grid, times);
  if (offer_.grids == GridForm::Drifting) move_frame(grid);
  date(grid, time.posted);
  cells_.add(grid.resolution, grid.origin.position.x, grid.origin.position.y, grid.width, grid.cells);
  return grid;
}

/// Adds points about the robot, as a denser lidar would measure them, until there are so many bytes.
void MapMaker::fill(Cloud& cloud, std::size_t bytes, const Vector3& here) {
  constexpr double range = 12, height = 3;  // metres
  while (cloud.data.size() < bytes) {
    const double angle = random_.uniform(0, 2 * std::numbers::pi), far = random_.uniform(1, range);
    const std::array<float, 4> point = {static_cast<float>(here.x + far * std::cos(angle)),
                                        static_cast<float>(here.y + far * std::sin(angle)),
                                        static_cast<float>(here.z + random_.uniform(0, height)),
                                        static_cast<float>(random_.uniform_index(100))};
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
