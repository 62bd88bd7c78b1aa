#pragma once

#include <optional>
#include <string>

#include "applier/rauc.hpp"
#include "update/messages.hpp"

namespace adit::applier {

/// What is on a USB stick, in a folder that is mounted read-only.
struct OnStick {
  std::optional<update::Offer> offer;  // the newest that could be installed
  std::string trouble;                 // where there is none: why not what there is; or ""
};

/// Looks at the files `adit-*.raucb` at the stick's top.
OnStick look_at_stick(const std::string& folder, const Rauc& rauc, const update::Running& running);

}  // namespace adit::applier
