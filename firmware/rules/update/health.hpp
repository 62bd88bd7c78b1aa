#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace adit::update {

/// The value of NAME=VALUE in the lines, or "".
std::string_view value_of(std::string_view name, std::string_view lines);

/// Time since aditd became ready, or std::nullopt while it is not, as systemd reports.
using Ready = std::optional<std::chrono::microseconds>;

/// Reads `systemctl show --property=ActiveState,ActiveEnterTimestampMonotonic`. `now`: CLOCK_MONOTONIC.
Ready read_ready(std::string_view properties, std::chrono::microseconds now);

enum class Health : std::uint8_t {
  Wait,     // ask again
  Good,     // mark the slot good
  Restart,  // restart the machine, which counts against the slot
};

/// Uninterrupted time for which aditd must be ready, with its watchdog fed, on a slot on trial.
inline constexpr std::chrono::seconds kHealthyFor{60};
/// Time limit of a slot on trial.
inline constexpr std::chrono::seconds kGoodWithin{300};

/// Why no update is installed while that version is on trial.
std::string wait_for_trial(std::string_view version);

/// `late`: kGoodWithin is over. A slot not on trial is good once aditd is ready, so that short runs (a loose
/// plug) do not count against it. It causes no restart, as its fault is the settings, which a user corrects.
Health classify(bool trial, const Ready& ready, bool late);

}  // namespace adit::update
