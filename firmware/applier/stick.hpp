#pragma once

#include <optional>
#include <string>

#include "applier/rauc.hpp"
#include "update/messages.hpp"

namespace adit::applier {

/// The best update on the mounted USB sticks.
struct OnStick {
  std::optional<update::Offer> offer;  // the newest installable one
  std::string path;                    // its file
  std::string trouble;                 // without an offer: why the files cannot be installed, or ""
};

/// Checks files `adit-*.raucb` at the top of each stick, the eight with the most promising names. The sticks
/// are mounted read-only in the directories of `folder`.
OnStick look_at_sticks(const std::string& folder, const Rauc& rauc, const update::Running& running);

}  // namespace adit::applier
