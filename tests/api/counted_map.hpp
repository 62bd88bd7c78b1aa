#pragma once

#include "api/source.hpp"

namespace adit::api {

/// Returns the covered area of the source's picture synchronously.
struct CountedMap final : CoveredMap {
  explicit CountedMap(const Source& shown) : source(shown) {}
  void count(Done done) override {
    picture::CoveredArea area;
    area.update(area.changes(source.map()));
    done(area.now());
  }
  const Source& source;
};

}  // namespace adit::api
