#pragma once

#include <string>

#include "api/run_view.hpp"

namespace adit::cli {

/// Whether the updates of one row reach the Command Post.
enum class Arrival : std::uint8_t { Yes, Late, No, Silent, NotYet };
Arrival arrival_of(const api::ActivityRow& row, api::Time now);

inline constexpr double kLateAfter = 5;     // seconds that the Command Post may be behind
inline constexpr double kSilentAfter = 30;  // seconds without anything new from the robot

/// What `adit status` prints.
std::string status_text(const api::RunView& view, bool colour);

}  // namespace adit::cli
