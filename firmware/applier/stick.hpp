#pragma once

#include <optional>
#include <string>

#include "applier/rauc.hpp"
#include "update/messages.hpp"

namespace adit::applier {

/// What is on the USB sticks that are in.
struct OnStick {
  std::optional<update::Offer> offer;  // the newest that could be installed
  std::string path;                    // of its file
  std::string trouble;                 // where there is none: why not what there is; or ""
};

/// Looks at the files `adit-*.raucb` at the top of each stick: of each folder of `folder`, in which they are
/// mounted read-only. At most at eight of them, those whose names promise most.
OnStick look_at_sticks(const std::string& folder, const Rauc& rauc, const update::Running& running);

}  // namespace adit::applier
