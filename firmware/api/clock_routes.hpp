#pragma once

#include <functional>
#include <string>

#include "api/clock.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// The time of day. README.md has the routes.
class ClockRoutes {
 public:
  /// `clock` outlives this. `changed` is called when the page shows something else.
  ClockRoutes(Clock& clock, std::function<void()> changed) : clock_(clock), changed_(std::move(changed)) {}

  intake::Answer shown() const;
  intake::Answer set(const std::string& body);

 private:
  Clock& clock_;
  std::function<void()> changed_;
};

}  // namespace adit::api
