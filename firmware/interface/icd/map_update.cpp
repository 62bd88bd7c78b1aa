#include "icd/map_update.hpp"

namespace adit::icd {

std::size_t size_of(Datatype datatype) {
  switch (datatype) {
    case Datatype::Int8:
    case Datatype::Uint8:
      return 1;
    case Datatype::Int16:
    case Datatype::Uint16:
      return 2;
    case Datatype::Int32:
    case Datatype::Uint32:
    case Datatype::Float32:
      return 4;
    case Datatype::Float64:
      return 8;
  }
  return 0;
}

const Header& MapUpdate::header() const {
  if (const auto* grid = std::get_if<OccupancyGrid>(&msg)) return grid->header;
  return std::get<PointCloud2>(msg).header;
}

Header& MapUpdate::header() {
  if (auto* grid = std::get_if<OccupancyGrid>(&msg)) return grid->header;
  return std::get<PointCloud2>(msg).header;
}

}  // namespace adit::icd
