#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "icd/status.hpp"
#include "picture/mosaic.hpp"

namespace adit::api {

/// The levels of the map that are finer than the mosaic's, of now alone.
class FinerMap {
 public:
  using Done = std::function<void(icd::Checked<picture::Tile>)>;

  virtual ~FinerMap() = default;
  /// What there is of a layer, and what of it changed after version `since`.
  virtual std::optional<picture::Finer> finer(const picture::Layer& layer, std::uint64_t since) const = 0;
  /// Draws it where that is not done, `at` being in the world: `done` is called then, or at once. Null:
  /// nothing finer is known there. An error: too many wait.
  virtual void tile(const picture::Layer& layer, const picture::TileAt& at, Done done) = 0;
};

}  // namespace adit::api
