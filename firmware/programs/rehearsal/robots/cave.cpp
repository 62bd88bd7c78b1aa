#include "rehearsal/robots/cave.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <numbers>
#include <utility>

namespace adit::robots {
namespace {

/// 1 where the mountain is hollow.
using Hollow = Raster<std::uint8_t>;

struct Chamber {
  double x = 0, y = 0, floor = 0, radius = 0;  // metres
};

constexpr int kRim = 3;  // cells of rock left standing all round

double distance(const Chamber& a, const Chamber& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

bool inside_rim(const Lattice& lattice, Cell cell) {
  return cell.x >= kRim && cell.y >= kRim && cell.x < lattice.width - kRim && cell.y < lattice.height - kRim;
}

void carve_disc(Hollow& hollow, double x, double y, double radius) {
  const Lattice& lattice = hollow.lattice();
  const Cell low = lattice.cell_at(x - radius, y - radius);
  const Cell high = lattice.cell_at(x + radius, y + radius);
  for (int cy = low.y; cy <= high.y; ++cy) {
    for (int cx = low.x; cx <= high.x; ++cx) {
      const Cell cell{cx, cy};
      if (inside_rim(lattice, cell) &&
          std::hypot(lattice.centre_x(cell) - x, lattice.centre_y(cell) - y) <= radius) {
        hollow[cell] = 1;
      }
    }
  }
}

/// A disc and a few smaller ones on its edge: chambers are not round.
void carve_chamber(Hollow& hollow, const Chamber& chamber, Random& random) {
  carve_disc(hollow, chamber.x, chamber.y, chamber.radius);
  for (int bulge = 0; bulge < 4; ++bulge) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    carve_disc(hollow, chamber.x + chamber.radius * std::cos(angle),
               chamber.y + chamber.radius * std::sin(angle), chamber.radius * random.uniform(0.3, 0.6));
  }
}

/// A walk towards `to` that wanders at most 60 degrees off the straight way, so that it always arrives.
void carve_tunnel(Hollow& hollow, const Chamber& from, const Chamber& to, Random& random) {
  constexpr double kStep = 0.3;
  constexpr double kWander = std::numbers::pi / 3;
  double x = from.x, y = from.y, off = 0, radius = 1.2;
  while (std::hypot(to.x - x, to.y - y) > 1) {
    off = std::clamp(off + random.uniform(-0.25, 0.25), -kWander, kWander);
    radius = std::clamp(radius + random.uniform(-0.08, 0.08), 0.9, 1.8);
    const double heading = std::atan2(to.y - y, to.x - x) + off;
    x += kStep * std::cos(heading);
    y += kStep * std::sin(heading);
    carve_disc(hollow, x, y, radius);
  }
}

/// The shortest tunnels that join all chambers (Prim), and a few more that close loops.
std::vector<std::pair<std::size_t, std::size_t>> tunnels_between(const std::vector<Chamber>& chambers,
                                                                 Random& random) {
  std::vector<std::pair<std::size_t, std::size_t>> tunnels;
  std::vector<bool> joined(chambers.size(), false);
  joined[0] = true;
  for (std::size_t round = 1; round < chambers.size(); ++round) {
    std::pair<std::size_t, std::size_t> best;
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < chambers.size(); ++a) {
      for (std::size_t b = 0; b < chambers.size(); ++b) {
        if (joined[a] && !joined[b] && distance(chambers[a], chambers[b]) < shortest) {
          shortest = distance(chambers[a], chambers[b]);
          best = {a, b};
        }
      }
    }
    joined[best.second] = true;
    tunnels.push_back(best);
  }
  for (int extra = 0; extra < 4; ++extra) {
    tunnels.emplace_back(random.uniform_index(chambers.size()), random.uniform_index(chambers.size()));
  }
  return tunnels;
}

int open_neighbours(const Hollow& hollow, Cell cell) {
  int open = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) open += hollow[{cell.x + dx, cell.y + dy}];
  }
  return open;
}

/// Crumbles the walls, then lets a cellular automaton smooth them: a cell is open where most of the nine
/// around it are.
void weather(Hollow& hollow, Random& random) {
  const Lattice& lattice = hollow.lattice();
  for (int round = 0; round < 4; ++round) {
    const Hollow before = hollow;
    for (std::size_t i = 0; i < lattice.size(); ++i) {
      const Cell cell = lattice.cell_at(i);
      if (!inside_rim(lattice, cell)) continue;
      const int open = open_neighbours(before, cell);
      if (round < 2) {
        if (open > 0 && open < 9 && before[cell] == 0 && random.chance(0.25)) hollow[cell] = 1;
      } else {
        hollow[cell] = open >= 5 ? 1 : 0;
      }
    }
  }
}

void fill_unreachable(Hollow& hollow, Cell entrance) {
  Hollow reached(hollow.lattice(), 0);
  std::vector<Cell> edge = {entrance};
  reached[entrance] = 1;
  while (!edge.empty()) {
    const Cell cell = edge.back();
    edge.pop_back();
    for (const Cell step : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
      const Cell next{cell.x + step.x, cell.y + step.y};
      if (hollow[next] == 0 || reached[next] != 0) continue;
      reached[next] = 1;
      edge.push_back(next);
    }
  }
  hollow = std::move(reached);
}

/// The entrance at (0, 0), which is the first, and chambers spread over the lattice.
std::vector<Chamber> spread_chambers(const Lattice& lattice, Random& random) {
  constexpr std::size_t kChambers = 11;
  constexpr double kMargin = 6;    // metres from the lattice's edge
  constexpr double kSpacing = 13;  // metres between centres
  std::vector<Chamber> chambers = {{.x = 0, .y = 0, .floor = 0, .radius = 3.5}};
  const double right = lattice.left + lattice.width * lattice.resolution;
  const double top = lattice.bottom + lattice.height * lattice.resolution;
  for (int attempt = 0; attempt < 2000 && chambers.size() < kChambers; ++attempt) {
    const Chamber candidate{.x = random.uniform(lattice.left + kMargin, right - kMargin),
                            .y = random.uniform(lattice.bottom + kMargin, top - kMargin),
                            .floor = random.uniform(-6, 4),
                            .radius = random.uniform(2.5, 6)};
    bool apart = true;
    for (const Chamber& other : chambers) apart = apart && distance(candidate, other) >= kSpacing;
    if (apart) chambers.push_back(candidate);
  }
  return chambers;
}

/// Carves chambers and joining tunnels, roughens the walls, and fills cells unreachable from the entrance.
Hollow carve(const Lattice& lattice, const std::vector<Chamber>& chambers, Random& random) {
  Hollow hollow(lattice, 0);
  for (const Chamber& chamber : chambers) carve_chamber(hollow, chamber, random);
  for (const auto& [from, to] : tunnels_between(chambers, random)) {
    carve_tunnel(hollow, chambers[from], chambers[to], random);
  }
  weather(hollow, random);
  fill_unreachable(hollow, lattice.cell_at(chambers.front().x, chambers.front().y));
  return hollow;
}

constexpr Lattice kLattice{.resolution = 0.2, .left = -6, .bottom = -32, .width = 480, .height = 320};

constexpr std::size_t kArtifacts = 2 * kArtifactTypes.size();

/// The floor blends the chambers' heights by distance; the ceiling is high in chambers, low between them.
void raise(const std::vector<Chamber>& chambers, double x, double y, float& floor, float& ceiling) {
  double weights = 0, heights = 0, room = 0;
  for (const Chamber& chamber : chambers) {
    const double squared = std::pow(x - chamber.x, 2) + std::pow(y - chamber.y, 2);
    const double weight = 1 / (squared + 4);
    weights += weight;
    heights += weight * chamber.floor;
    room = std::max(room, chamber.radius * std::exp(-squared / (2 * chamber.radius * chamber.radius)));
  }
  const double ripple = 0.08 * std::sin(1.7 * x) * std::cos(1.3 * y);
  floor = static_cast<float>(heights / weights + ripple);
  ceiling = static_cast<float>(heights / weights + 2.2 + room);
}

}  // namespace

Cave::Cave(const Lattice& lattice) : open_(lattice, 0), floor_(lattice, 0), ceiling_(lattice, 0) {}

Cave Cave::generate(std::uint64_t seed) {
  Random random(seed);
  Cave cave(kLattice);
  const std::vector<Chamber> chambers = spread_chambers(kLattice, random);
  cave.open_ = carve(kLattice, chambers, random);
  for (std::size_t i = 0; i < kLattice.size(); ++i) {
    const Cell cell = kLattice.cell_at(i);
    raise(chambers, kLattice.centre_x(cell), kLattice.centre_y(cell), cave.floor_[cell], cave.ceiling_[cell]);
  }
  const float entrance = cave.floor_[cave.entrance()];  // becomes z = 0
  for (std::size_t i = 0; i < kLattice.size(); ++i) {
    cave.floor_[kLattice.cell_at(i)] -= entrance;
    cave.ceiling_[kLattice.cell_at(i)] -= entrance;
  }
  cave.place_artifacts(random);
  return cave;
}

bool Cave::can_see(const Vector3& from, const Vector3& to) const {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const int steps = static_cast<int>(std::ceil(length / (lattice().resolution / 2)));
  for (int step = 0; step <= steps; ++step) {
    const double along = steps == 0 ? 0 : static_cast<double>(step) / steps;
    const double x = from.x + along * (to.x - from.x);
    const double y = from.y + along * (to.y - from.y);
    if (!is_open(lattice().cell_at(x, y))) return false;
  }
  return true;
}

void Cave::place_artifacts(Random& random) {
  std::vector<Vector3> places;
  for (std::size_t i = 0; i < lattice().size(); ++i) {
    const Cell cell = lattice().cell_at(i);
    if (is_open(cell)) {
      places.push_back({lattice().centre_x(cell), lattice().centre_y(cell), floor_at(cell) + 0.15});
    }
  }
  constexpr double kNear = 5.5;  // metres: the first is found at once, so that the shortest run reports
  const std::size_t first_type = random.uniform_index(kArtifactTypes.size());
  for (int attempt = 0; attempt < 200'000 && artifacts_.size() < kArtifacts; ++attempt) {
    const Vector3& place = places[random.uniform_index(places.size())];
    if (artifacts_.empty() && (std::hypot(place.x, place.y) > kNear || !can_see({}, place))) continue;
    const bool apart = std::ranges::all_of(artifacts_, [&](const Artifact& other) {
      return std::hypot(place.x - other.position.x, place.y - other.position.y) >= kApart;
    });
    if (!apart) continue;
    artifacts_.push_back(
        {std::string(kArtifactTypes[(first_type + artifacts_.size()) % kArtifactTypes.size()]), place});
  }
}

std::string Cave::truth_csv() const {
  std::string csv = "type,x,y,z\n";
  for (const Artifact& artifact : artifacts_) {
    std::array<char, 96> place{};
    (void)std::snprintf(place.data(), place.size(), ",%.3f,%.3f,%.3f\n", artifact.position.x,
                        artifact.position.y, artifact.position.z);
    csv += artifact.type + place.data();
  }
  return csv;
}

}  // namespace adit::robots
