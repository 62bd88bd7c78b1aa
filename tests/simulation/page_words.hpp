#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "simulation/history.hpp"

namespace adit::simulation {

/// In what the panel's lights, or what systemd was told, disagree with a view of the page by which the first
/// `count` events had happened; "": in nothing.
std::string disagreement(const nlohmann::json& view, const std::vector<Event>& events, std::size_t count);

/// Whether an alarm of a view calls the operator.
bool calls(const nlohmann::json& alarm);
/// It, in a line.
std::string said(const nlohmann::json& alarm);

/// How many reports a view shows in that state in the present run.
std::int64_t reports_in(const nlohmann::json& view, const std::string& state);

}  // namespace adit::simulation
