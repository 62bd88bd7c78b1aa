#pragma once

#include <chrono>
#include <expected>
#include <functional>
#include <memory>
#include <string>

#include "panel/button.hpp"
#include "panel/lines.hpp"

namespace adit::panel {

/// So often what was lost, or could not be had yet, is opened: a chip may come late, vanish and come back.
inline constexpr std::chrono::milliseconds kReopen{2000};

/// Lines that are let go of and opened again where they fail for kReopen. Until they can be set, that is an
/// error, and `stand_in` (may be null, or make none) shows what they should.
std::unique_ptr<Lines> reopened_lines(
    std::function<std::expected<std::unique_ptr<Lines>, std::string>()> open,
    std::function<std::unique_ptr<Lines>()> stand_in,
    std::function<Instant()> now = [] { return std::chrono::steady_clock::now(); });

/// A button that is let go of where it cannot be read, and opened again. It is looked at each `pace` besides:
/// a chip that has vanished tells of no press. pressed() is an error at least once for each loss.
std::expected<std::unique_ptr<ButtonLine>, std::string> reopened_button(
    std::function<std::expected<std::unique_ptr<ButtonLine>, std::string>()> open,
    std::chrono::milliseconds pace = kReopen);

}  // namespace adit::panel
