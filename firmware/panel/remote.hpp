#pragma once

#include <memory>
#include <string>

#include "loop/file_descriptor.hpp"
#include "panel/lines.hpp"

namespace adit::panel {

/// Lights and button that adit-panel holds, at its `socket`. It is told where the lines are (`settings`),
/// unless its board has told it. Where it is not there, or goes, it is connected to again by what is set;
/// that it does not answer is told after half a minute. A button that is held when it is connected to is none
/// until it was let go.
struct Remote {
  std::unique_ptr<Lines> lines;
  std::unique_ptr<ButtonLine> button;
};
std::expected<Remote, std::string> remote(const std::string& socket, const settings::Panel& settings,
                                          loop::FileDescriptor announced = {});

/// A connection to adit-panel for remote(), before it is known what is to be lit: where it ends before that,
/// adit-panel shows the fault. Empty where nobody answers there.
loop::FileDescriptor announce(const std::string& socket);

}  // namespace adit::panel
