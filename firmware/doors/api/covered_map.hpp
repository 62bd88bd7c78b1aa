#pragma once

#include <functional>

#include "icd/status.hpp"
#include "picture/covered.hpp"

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

}  // namespace adit::api
