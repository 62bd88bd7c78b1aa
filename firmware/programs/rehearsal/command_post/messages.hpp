#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "rehearsal/command_post/geometry.hpp"
#include "rehearsal/command_post/json.hpp"

namespace adit::rehearsal {

/// A map's `data` inflates to no more than this, so that a bomb cannot fill the memory.
inline constexpr std::size_t kMostMapBytes = std::size_t{512} << 20;

/// ICD 6.3.1, without its cells.
struct Grid {
  double resolution = 0;
  std::uint32_t width = 0, height = 0;
  Pose origin;
};

struct CloudField {
  std::string name;
  std::uint32_t offset = 0;
  std::uint32_t datatype = 7;
  std::uint32_t count = 1;
};

/// Bytes of one value of a PointField datatype (ICD 6.3.2); `datatype` from 1 to 8.
std::uint32_t size_of_datatype(std::uint32_t datatype);

/// ICD 6.3.2, without its points.
struct Cloud {
  std::optional<Pose> origin;
  std::vector<CloudField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0;
};

/// POST /map/update (ICD 6.4).
struct MapMessage {
  std::string name;  // "": merged
  std::variant<Grid, Cloud> msg;
  std::string data;  // inflated
  std::vector<Stamp> stamps;
};

/// POST /markers/update (ICD 6.6): what each marker says of which one.
struct MarkerChange {
  std::string ns;
  std::int64_t id = 0;
  std::int64_t action = 0;
  double x = 0;  // metres
};

/// Reads a document and writes down all that the ICD or the measured server minds. Nothing where so much
/// is wrong that there is no message; a message that is there may still have decisive findings.
std::optional<MapMessage> read_map(const Json& document, Format format, Findings& findings);

}  // namespace adit::rehearsal
