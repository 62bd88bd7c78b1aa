#pragma once

#include <expected>
#include <string>

#include "loop/file_descriptor.hpp"
#include "panel/held.hpp"

namespace adit::panel {

/// Lights and button that adit-panel holds, at its `socket`. It is told where the lines are (`settings`),
/// unless its board has told it. Where it is not there, or goes, it is connected to again by what is set;
/// that it does not answer is an error of set() after half a minute, and that it cannot set the lights is one
/// as soon as the button was looked at. A button that is held when it is connected to is none until it was
/// let go, and a press that is under way when it goes, or cannot read the button, comes to nothing.
std::expected<Held, std::string> remote(const std::string& socket, const settings::Panel& settings,
                                        loop::FileDescriptor announced = {});

/// A connection to adit-panel for remote(), before it is known what is to be lit: where it ends before that,
/// adit-panel shows the fault. Empty where nobody answers there.
loop::FileDescriptor announce(const std::string& socket);

}  // namespace adit::panel
