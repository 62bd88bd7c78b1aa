#pragma once

#include <optional>

#include "access/role.hpp"

namespace adit::access {

/// A time during which a person at the box is trusted. Requests from a network cannot open it. It is kept in
/// memory only, so a restart closes it.
class Window {
 public:
  /// Opens it for `length` from now, even if it is open already.
  void open(Instant now, Duration length) { until_ = now + length; }
  /// Closes it after use.
  void close() { until_.reset(); }
  /// The rest of its time, or nullopt if it is closed.
  std::optional<Duration> left(Instant now) const {
    return until_ && now < *until_ ? std::optional<Duration>(*until_ - now) : std::nullopt;
  }

 private:
  std::optional<Instant> until_;
};

}  // namespace adit::access
