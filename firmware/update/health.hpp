#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace adit::update {

/// The value of NAME=VALUE in one of the lines, or "".
std::string_view value_of(std::string_view name, std::string_view lines);

/// What systemd says of aditd: nothing while it is not ready, or how long it has been since.
using Ready = std::optional<std::chrono::microseconds>;

/// Out of `systemctl show --property=ActiveState,ActiveEnterTimestampMonotonic`; `now`: CLOCK_MONOTONIC.
Ready read_ready(std::string_view properties, std::chrono::microseconds now);

enum class Health : std::uint8_t {
  Wait,     // ask again
  Good,     // the slot is to be marked good
  Restart,  // the machine is to be restarted, which counts against the slot
};

/// A slot on trial is good once aditd has been ready, and its watchdog fed, for so long without a break.
inline constexpr std::chrono::seconds kHealthyFor{60};
/// For so long a slot on trial may be not good.
inline constexpr std::chrono::seconds kGoodWithin{300};

/// Why nothing is installed while that version is on trial.
std::string wait_for_trial(std::string_view version);

/// `late`: kGoodWithin is over. A slot that is not on trial is good as soon as aditd is ready, so that short
/// lives (a loose plug) do not count against it, and never ends in a restart: what is wrong with it are its
/// settings, and they are set right on a box that stays up.
Health judge(bool trial, const Ready& ready, bool late);

}  // namespace adit::update
