#pragma once

#include <string>

#include "api/clock.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// The time of day. README.md has the routes.
class ClockRoutes {
 public:
  /// `clock` must outlive this object.
  explicit ClockRoutes(Clock& clock) : clock_(clock) {}

  intake::Answer shown() const;
  intake::Answer set(const std::string& body);

 private:
  Clock& clock_;
};

}  // namespace adit::api
