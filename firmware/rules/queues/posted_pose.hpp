#pragma once

#include <optional>
#include <string>

#include "icd/state_update.hpp"

namespace adit::queues {

/// A robot's pose and the time stamp of its post.
struct PostedPose {
  icd::RobotName name;
  icd::Pose pose;
  std::optional<icd::Stamp> stamp = {};  // on the gateway's clock
  std::string address = {};              // of the client that stamped it; "": not stamped by a client

  /// Whether this pose is older than `held`, which came before it. Two stamps are compared only if one client
  /// set both, because only then they are from one clock. Otherwise false.
  bool is_older_than(const PostedPose& held) const {
    return !address.empty() && address == held.address && stamp < held.stamp;
  }
  icd::NamedPose named() const { return {name, pose}; }
  friend bool operator==(const PostedPose&, const PostedPose&) = default;
};

}  // namespace adit::queues
