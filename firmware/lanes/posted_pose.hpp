#pragma once

#include <optional>
#include <string>

#include "icd/state_update.hpp"

namespace adit::lanes {

/// A robot's pose, and when it was posted.
struct PostedPose {
  icd::RobotName name;
  icd::Pose pose;
  std::optional<icd::Stamp> stamp = {};  // on the gateway's clock
  std::string address = {};              // of the client that stamped it; "": no client did

  /// The order of two poses of one robot: by their stamps if one client stamped both, for it did so by one
  /// clock; else `held`, which came first, is the older one.
  bool is_older_than(const PostedPose& held) const {
    return !address.empty() && address == held.address && stamp < held.stamp;
  }
  icd::NamedPose named() const { return {name, pose}; }
  friend bool operator==(const PostedPose&, const PostedPose&) = default;
};

}  // namespace adit::lanes
