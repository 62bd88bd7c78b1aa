#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "icd/map_update.hpp"
#include "icd/robot_name.hpp"
#include "icd/status.hpp"

namespace adit::icd {

inline constexpr std::uint32_t kMostCellsASide = 0x7fffffff;  // width and height are ROS's, read as int32
inline constexpr std::uint32_t kLargestPoint = 65536;         // bytes; far above any sensor's
inline constexpr std::size_t kMostFields = 256;

inline constexpr std::size_t kMostMapBytes = std::size_t{1} << 30;  // what rules.map_bytes may be set to

/// Where a team may bend the ICD's rules, by its settings.
struct Rules {
  bool rewrite_frame_id = false;       // take any frame_id and send "darpa" (else 422)
  bool forward_unknown_types = false;  // send artifact types that are none of the ten (else 422)
  std::size_t map_bytes = 256u << 20;  // largest `data` of a map once inflated
  std::map<std::string, RobotName, std::less<>> aliases = {};  // what a robot calls itself, and its name
};

/// Rules over several fields of a map, once each field has its type. Each names the field by its path in the
/// body, as in "msg.point_step: expected at least 1, got 0".

/// ICD 6.3.1: resolution, width and height; and that width * height is within rules.map_bytes.
Checked<void> check(const OccupancyGrid& grid, const Rules& rules);
/// Requires check(grid). ICD 6.3.1: "msg.info.width: expected 80 x 60 = 4800 bytes of data, got 4799".
Checked<void> check_size(const OccupancyGrid& grid, std::size_t bytes);
/// ICD 6.3.1: cell values are 0 to 100 or 255. `first` is the index of cells.front() in the grid.
Checked<void> check_cells(std::span<const std::uint8_t> cells, std::size_t first);
/// How many of the first of them are, before one that is not.
std::size_t sound_cells(std::span<const std::uint8_t> cells);

/// ICD 6.3.2 and what kills a server: point_step, the fields' places, x y z present and of one float type.
Checked<void> check(const PointCloud2& cloud, const Rules& rules);
/// ICD 6.3.2: the data is a whole number of points. Requires check(cloud).
Checked<void> check_size(const PointCloud2& cloud, std::size_t bytes);

/// ICD 6.3.1: how many bytes of data a checked grid has.
inline std::size_t cells_of(const OccupancyGrid& grid) {
  return std::size_t{grid.width} * grid.height;
}

/// ICD 6.1, at `path` ("msg.header.frame_id").
Checked<void> check_frame_id(std::string_view frame_id, std::string_view path, const Rules& rules);

}  // namespace adit::icd
