#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "picture/draw.hpp"
#include "picture/mosaic.hpp"

namespace adit::picture {

/// The area that grids show as known, in pixels of the base: squares of kPixel metres.
struct Coverage {
  std::uint64_t version = 0;                // Mosaic::version() of this count
  std::map<std::string, std::uint64_t> of;  // by robot with known cells; "": the merged map
  std::uint64_t all = 0;                    // a pixel that several robots know counts once
  bool is_whole = true;                     // false: the picture lacks parts of grids, so the area is larger
};

/// The area of so many pixels of the base.
constexpr double square_metres(std::uint64_t pixels) {
  return static_cast<double>(pixels) * kPixel * kPixel;
}

/// Counts the covered area on request. Only places whose tiles changed are counted again. Keeps at most about
/// 100 bytes for each place and 40 for each tile.
class CoveredArea {
 public:
  /// Tiles of places that changed, and facts for the result.
  struct Changes {
    std::map<TileIndex, std::vector<std::pair<std::string, Tile>>> places;
    std::uint64_t version = 0;
    bool is_whole = true;
  };
  /// The changes since the last update().
  Changes changes(const Mosaic& mosaic) const;
  /// Inflates the changed tiles: 64 KB each, one place at a time. Call it on a worker.
  void update(const Changes& changes, const Between& between = [] {});
  /// The state after the last update(), which must have returned.
  Coverage now() const;

 private:
  struct Counts {
    std::uint32_t all = 0;
    std::vector<std::pair<std::string, std::uint32_t>> of;
  };
  std::map<TileIndex, Counts> places_;
  std::uint64_t version_ = 0;
  bool is_whole_ = true;
};

/// Coverage::all over time, oldest first, as far back and as fine as the picture keeps earlier states. A
/// pixel that was known once stays covered. Inflates every state.
std::vector<std::pair<double, std::uint64_t>> covered_over_time(const Mosaic& mosaic);

}  // namespace adit::picture
