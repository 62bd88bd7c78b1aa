#pragma once

#include <memory>
#include <string>

#include "api/route.hpp"
#include "api/updates.hpp"

namespace adit::api {

/// Updates of the box: README.md.
class UpdateRoutes {
 public:
  /// `updates` must outlive this object.
  explicit UpdateRoutes(Updates& updates) : updates_(updates) {}

  /// Receives a bundle as a stream.
  std::unique_ptr<intake::BodySink> receive(const Call& call);

 private:
  Updates& updates_;
};

}  // namespace adit::api
