#include "rehearsal/command_post/artifacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>

#include "rehearsal/command_post/fields.hpp"

namespace adit::rehearsal {
namespace {

constexpr auto kTypes = std::to_array<std::string_view>({
#include "icd/artifact_types.inc"
});

constexpr double kScoringDistance = 5.0;  // metres, by the competition's rules

bool same_letters(std::string_view a, std::string_view b) {
  return lower(std::string(a)) == lower(std::string(b));
}

std::optional<Artifact> artifact_of(std::string_view line) {
  std::array<std::string_view, 4> cells;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto comma = line.find(',');
    if ((comma == std::string_view::npos) != (i + 1 == cells.size())) return std::nullopt;
    cells[i] = trimmed(line.substr(0, comma));
    line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
  }
  constexpr double kMost = std::numeric_limits<double>::max();
  const auto x = number_of(cells[1], -kMost, kMost), y = number_of(cells[2], -kMost, kMost),
             z = number_of(cells[3], -kMost, kMost);
  if (!is_artifact_type(cells[0]) || !x || !y || !z) return std::nullopt;
  return Artifact{std::string(cells[0]), {*x, *y, *z}};
}

}  // namespace

bool is_artifact_type(std::string_view type) {
  return std::ranges::any_of(kTypes, [type](std::string_view known) { return same_letters(known, type); });
}

std::expected<std::vector<Artifact>, std::string> read_artifacts(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) return std::unexpected(path + ": cannot be read");
  if (trimmed(line) != "type,x,y,z") return std::unexpected(path + ":1: expected the header type,x,y,z");
  std::vector<Artifact> artifacts;
  for (int number = 2; std::getline(file, line); ++number) {
    if (trimmed(line).empty()) continue;
    auto artifact = artifact_of(line);
    if (!artifact) {
      return std::unexpected(path + ":" + std::to_string(number) +
                             ": expected an artifact type and three numbers, as in Cell Phone,1.5,-2,0");
    }
    artifacts.push_back(std::move(*artifact));
  }
  return artifacts;
}

bool claim(std::vector<Artifact>& artifacts, std::string_view type, const Point& position) {
  Artifact* nearest = nullptr;
  double least = kScoringDistance;
  for (Artifact& artifact : artifacts) {
    const double distance = std::hypot(artifact.position.x - position.x, artifact.position.y - position.y,
                                       artifact.position.z - position.z);
    if (artifact.claimed || distance > least || !same_letters(artifact.type, type)) continue;
    nearest = &artifact;
    least = distance;
  }
  if (nearest != nullptr) nearest->claimed = true;
  return nearest != nullptr;
}

}  // namespace adit::rehearsal
