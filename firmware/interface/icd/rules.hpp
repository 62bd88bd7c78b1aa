#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "icd/mapping.hpp"
#include "icd/robot_name.hpp"
#include "icd/status.hpp"

namespace adit::icd {

inline constexpr std::uint32_t kMostCellsASide = 0x7fffffff;  // of width or height; ROS reads them as int32
inline constexpr std::uint32_t kLargestPoint = 65536;         // bytes; far above that of any sensor
inline constexpr std::size_t kMostFields = 256;

inline constexpr std::size_t kMostMapBytes = std::size_t{1} << 30;  // maximum of rules.map_bytes

/// The settings with which a team may relax the ICD's rules.
struct Rules {
  bool rewrite_frame_id = false;       // accept any frame_id and send "darpa" (else 422)
  bool forward_unknown_types = false;  // send artifact types that are not one of the ten (else 422)
  std::size_t map_bytes = 256u << 20;  // largest inflated `data` of a map
  std::map<std::string, RobotName, std::less<>> aliases = {};  // own name of a robot, to its name
};

/// Rules over several fields of a map, after each field was read. An error names the field by its path in the
/// body: "msg.point_step: expected at least 1, got 0".

/// ICD 6.3.1: resolution, width and height. width * height must be within rules.map_bytes.
Checked<void> check(const OccupancyGrid& grid, const Rules& rules);
/// Requires check(grid). ICD 6.3.1: "msg.info.width: expected 80 x 60 = 4800 bytes of data, got 4799".
Checked<void> check_size(const OccupancyGrid& grid, std::size_t bytes);
/// ICD 6.3.1: cell values are 0 to 100 or 255. `first` is the index of cells.front() in the grid.
Checked<void> check_cells(std::span<const std::uint8_t> cells, std::size_t first);
/// The number of valid cells before the first invalid one.
std::size_t sound_cells(std::span<const std::uint8_t> cells);

/// ICD 6.3.2, and clouds that crash servers: point_step, fields' places, x y z present and of one float type.
Checked<void> check(const PointCloud2& cloud, const Rules& rules);
/// ICD 6.3.2: the data is a whole number of points. Requires check(cloud).
Checked<void> check_size(const PointCloud2& cloud, std::size_t bytes);

/// ICD 6.3.1: the bytes of data of a checked grid.
inline std::size_t cells_of(const OccupancyGrid& grid) {
  return std::size_t{grid.width} * grid.height;
}

/// ICD 6.1. `path` is for the error ("msg.header.frame_id").
Checked<void> check_frame_id(std::string_view frame_id, std::string_view path, const Rules& rules);

}  // namespace adit::icd
