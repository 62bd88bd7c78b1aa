#pragma once

#include <chrono>
#include <expected>
#include <functional>
#include <memory>
#include <string>

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
/// a vanished chip reports no press. pressed() fails at least once for each loss.
std::expected<std::unique_ptr<ButtonLine>, std::string> reopened_button(
    std::function<std::expected<std::unique_ptr<ButtonLine>, std::string>()> open,
    std::chrono::milliseconds pace = kReopen);

}  // namespace adit::panel
