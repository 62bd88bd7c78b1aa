#pragma once

#include <expected>
#include <string>

#include "loop/file_descriptor.hpp"
#include "panel/held.hpp"

namespace adit::panel {

/// Lights and button held by adit-panel at `socket`. adit-panel ignores `settings` if its board names a
/// panel. set() reconnects if there is no connection. It fails after half a minute without a connection, or
/// if adit-panel has reported a failure of the lights. pressed() receives these reports. A button that is
/// held while connecting counts as not pressed until it is released. A press is cancelled if the connection
/// is lost or adit-panel cannot read the button. `announced`: a connection by announce().
std::expected<Held, std::string> remote(const std::string& socket, const settings::Panel& settings,
                                        loop::FileDescriptor announced = {});

/// Connects to adit-panel before the lights are known. If the program ends before it sets lights, adit-panel
/// shows the fault. Empty if it does not answer.
loop::FileDescriptor announce(const std::string& socket);

}  // namespace adit::panel
