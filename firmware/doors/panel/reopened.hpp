#pragma once

#include <chrono>
#include <expected>
#include <functional>
#include <memory>
#include <string>

#include "loop/file_descriptor.hpp"
#include "panel/button.hpp"
#include "panel/lines.hpp"

namespace adit::panel {

/// Interval for opening lost or missing lines: a chip may come late, vanish and come back.
inline constexpr std::chrono::milliseconds kReopen{2000};

/// Lines that are closed and opened again if they fail for kReopen. Until they can be set, set() fails and
/// `stand_in` shows the lights. `stand_in` may be null or return null.
std::unique_ptr<Lines> reopened_lines(
    std::function<std::expected<std::unique_ptr<Lines>, std::string>()> open,
    std::function<std::unique_ptr<Lines>()> stand_in,
    std::function<Instant()> now = [] { return std::chrono::steady_clock::now(); });

/// A button that is closed if it cannot be read, and opened again. It becomes readable every `pace`, because
/// a vanished chip reports no press. is_pressed() fails at least once for each loss.
std::expected<std::unique_ptr<ButtonLine>, std::string> reopened_button(
    std::function<std::expected<std::unique_ptr<ButtonLine>, std::string>()> open,
    std::chrono::milliseconds pace = kReopen);

struct PanelDevices {
  std::unique_ptr<Lines> lines;        // null: there are none
  std::unique_ptr<ButtonLine> button;  // null: there is none
};

/// Opens the panel of `settings` for `consumer` (shown by gpioinfo(1) as its user). Lines that are lost or
/// not available yet are opened again; until then set() and is_pressed() fail. `complain` gets an error of
/// the button. `simulated` is the file of a simulated panel; "": there is none. Its lights stand in for lines
/// that cannot be opened. Its button, `simulated`.button, is used only if `settings` names no line at all.
PanelDevices hold(const settings::Panel& settings, const std::string& consumer, const std::string& simulated,
                  const std::function<void(const std::string&)>& complain);

/// Lights and button held by adit-panel at `socket`. adit-panel ignores `settings` if its board names a
/// panel. set() reconnects if there is no connection. It fails after half a minute without a connection, or
/// if adit-panel has reported a failure of the lights. is_pressed() receives these reports. A button that is
/// held while connecting counts as not pressed until it is released. A press is cancelled if the connection
/// is lost or adit-panel cannot read the button. `announced`: a connection by announce().
std::expected<PanelDevices, std::string> remote(const std::string& socket, const settings::Panel& settings,
                                                loop::FileDescriptor announced = {});

/// Connects to adit-panel before the lights are known. If the program ends before it sets lights, adit-panel
/// shows the fault. Empty if it does not answer.
loop::FileDescriptor announce(const std::string& socket);

}  // namespace adit::panel
