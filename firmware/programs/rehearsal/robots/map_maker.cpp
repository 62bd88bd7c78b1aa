#include "rehearsal/robots/map_maker.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

namespace adit::robots {
namespace {

constexpr std::array<std::uint8_t, 5> kDateFollows = {13, 87, 42, 61, 99};  // no value of the cave's cells
constexpr std::size_t kDigits = 5;
constexpr std::uint64_t kBase = 101;
constexpr int kUint32 = 6;  // ICD 6.3.2
static_assert(std::endian::native == std::endian::little, "clouds are sent little endian");

std::uint64_t milliseconds_of(Moment moment) {
  return static_cast<std::uint64_t>(moment.time_since_epoch().count());
}

}  // namespace

void date(Grid& grid, Moment posted) {
  if (grid.width < kDateFollows.size() + kDigits) return;
  auto cell = std::ranges::copy(kDateFollows, grid.cells.begin()).out + kDigits;
  std::uint64_t rest = milliseconds_of(posted);
  for (std::size_t i = 0; i < kDigits; ++i, rest /= kBase) *--cell = static_cast<std::uint8_t>(rest % kBase);
}

void date(Cloud& cloud, Moment posted) {
  const std::uint32_t before = cloud.point_step;
  const auto date = static_cast<std::uint32_t>(milliseconds_of(posted));
  cloud.fields.push_back({"posted_ms", before, kUint32, 1});
  cloud.point_step += sizeof date;
  std::vector<std::uint8_t> dated(cloud.data.size() / before * cloud.point_step);
  for (std::size_t from = 0, to = 0; to < dated.size(); from += before, to += cloud.point_step) {
    std::memcpy(&dated[to], &cloud.data[from], before);
    std::memcpy(&dated[to + before], &date, sizeof date);
  }
  cloud.data = std::move(dated);
}

namespace {

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
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const auto* const known =
        std::ranges::find(names, text.substr(at, end - at), &std::pair<std::string_view, Form>::first);
    if (known == names.end()) {
      std::string sentence = "expected ";
      for (const auto& [name, form] : names) sentence.append(name).append(", ");
      return std::unexpected(sentence + "got '" + std::string(text) + "'");
    }
    forms.push_back(known->second);
    at = end + 1;
  }
  return forms;
}

}  // namespace

MapOffer MapOffers::of(std::size_t robot) const {
  return {.grids = grids[robot % grids.size()],
          .clouds = clouds[robot % clouds.size()],
          .grid_every = Seconds(1 / grid_hz.value_or(1)),
          .cloud_every = Seconds(cloud_hz ? 1 / *cloud_hz : kCloudEvery[robot % kCloudEvery.size()]),
          .grid_bytes = static_cast<std::size_t>(grid_mb * kMegabyte),
          .cloud_bytes = static_cast<std::size_t>(cloud_mb * kMegabyte)};
}

bool MapOffers::has_grids() const {
  return std::ranges::any_of(grids, [](GridForm form) { return form != GridForm::None; });
}

bool MapOffers::has_clouds() const {
  return std::ranges::any_of(clouds, [](CloudForm form) { return form != CloudForm::None; });
}

std::expected<std::vector<GridForm>, std::string> parse_grid_forms(std::string_view text) {
  return parse_forms(text, kGridForms);
}

std::expected<std::vector<CloudForm>, std::string> parse_cloud_forms(std::string_view text) {
  return parse_forms(text, kCloudForms);
}

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
