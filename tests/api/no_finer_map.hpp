#pragma once

#include <optional>

#include "api/source.hpp"

namespace adit::api {

struct NoFinerMap final : FineMap {
  std::optional<picture::FinerLevels> finer_levels(const picture::Layer&, std::uint64_t) const override {
    return {};
  }
  void tile(const picture::Layer&, const picture::TileIndex&, Done done) override { done(nullptr); }
};

}  // namespace adit::api
