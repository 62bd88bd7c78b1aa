#include "rehearsal/robots/cave.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "rehearsal/robots/carving.hpp"

namespace adit::robots {
namespace {

constexpr Lattice kLattice{.resolution = 0.2, .left = -6, .bottom = -32, .width = 480, .height = 320};

/// The ICD's artifact types (5.2).
constexpr auto kTypes = std::to_array<std::string_view>({
#include "icd/artifact_types.inc"
});
constexpr std::size_t kArtifacts = 2 * kTypes.size();

/// The floor blends the chambers' heights by their distance; the ceiling is high in chambers and low
/// between them.
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

bool Cave::in_sight(const Vector3& from, const Vector3& to) const {
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
  const std::size_t first_type = random.below(kTypes.size());
  for (int attempt = 0; attempt < 200'000 && artifacts_.size() < kArtifacts; ++attempt) {
    const Vector3& place = places[random.below(places.size())];
    if (artifacts_.empty() && (std::hypot(place.x, place.y) > kNear || !in_sight({}, place))) continue;
    const bool apart = std::ranges::all_of(artifacts_, [&](const Artifact& other) {
      return std::hypot(place.x - other.position.x, place.y - other.position.y) >= kApart;
    });
    if (!apart) continue;
    artifacts_.push_back({std::string(kTypes[(first_type + artifacts_.size()) % kTypes.size()]), place});
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
