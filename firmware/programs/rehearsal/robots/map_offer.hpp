#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace adit::robots {

/// What a robot's grids show: all that it knows; the same in a frame that SLAM corrects each time; the 10 m
/// about it; or one tile of what it knows after the other.
enum class GridForm : std::uint8_t { Whole, Drifting, Rolling, Tiles, None };

/// What a robot's clouds hold: the points that are new since the last one; or all of them each time.
enum class CloudForm : std::uint8_t { Differential, Whole, None };

/// The maps that one robot posts.
struct MapOffer {
  GridForm grids = GridForm::Whole;
  CloudForm clouds = CloudForm::Differential;
  std::chrono::duration<double> grid_every{1}, cloud_every{1};
  std::size_t grid_bytes = 0;   // of a grid of the whole cave, about; 0: as the cave is
  std::size_t cloud_bytes = 0;  // of a cloud at least; 0: what the lidar saw
};

/// The maps that a team posts: the robots take the forms in turn.
struct MapOffers {
  std::vector<GridForm> grids = {GridForm::Whole};
  std::vector<CloudForm> clouds = {CloudForm::Differential};
  std::optional<double> grid_hz, cloud_hz;  // absent: once a second; every 1, 0.5 or 2 s in turn
  double grid_mb = 0, cloud_mb = 0;         // megabytes

  MapOffer of(std::size_t robot) const;
  bool has_grids() const;
  bool has_clouds() const;
};

/// "whole,tiles": forms with commas between them; nothing if one is none.
std::optional<std::vector<GridForm>> read_grid_forms(std::string_view text);
std::optional<std::vector<CloudForm>> read_cloud_forms(std::string_view text);

}  // namespace adit::robots
