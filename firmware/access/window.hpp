#pragma once

#include <optional>

#include "access/role.hpp"

namespace adit::access {

/// For how long the word of somebody who was seen at the box itself is good. Nothing that comes over a
/// network opens it, and it is kept nowhere: a restart closes it.
class Window {
 public:
  /// From now on; where it is open already, for the whole time again.
  void open(Instant now, Duration length) { until_ = now + length; }
  /// It has been used.
  void close() { until_.reset(); }
  /// For how much longer it is open; nothing: it is not.
  std::optional<Duration> left(Instant now) const {
    return until_ && now < *until_ ? std::optional<Duration>(*until_ - now) : std::nullopt;
  }

 private:
  std::optional<Instant> until_;
};

}  // namespace adit::access
