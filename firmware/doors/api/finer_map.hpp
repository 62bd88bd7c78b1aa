#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "icd/status.hpp"
#include "picture/covered.hpp"
#include "picture/mosaic.hpp"

namespace adit::api {

/// The covered area of the present map, counted on request.
class CoveredMap {
 public:
  using Done = std::function<void(icd::Checked<picture::Covered>)>;

  virtual ~CoveredMap() = default;
  /// Counts the area if the map has changed, then calls `done`, perhaps at once. Error: too many requests are
  /// queued.
  virtual void covered(Done done) = 0;
};

/// Map levels finer than the mosaic's, for the present alone.
class FinerMap {
 public:
  using Done = std::function<void(icd::Checked<picture::Tile>)>;

  virtual ~FinerMap() = default;
  /// The existing tiles of a layer, and those changed after version `since`.
  virtual std::optional<picture::Finer> finer(const picture::Layer& layer, std::uint64_t since) const = 0;
  /// Draws the tile if necessary, then calls `done`, perhaps at once. `at` must be in the world. Null: no
  /// finer data there. Error: too many requests are queued.
  virtual void tile(const picture::Layer& layer, const picture::TileIndex& at, Done done) = 0;
};

}  // namespace adit::api
