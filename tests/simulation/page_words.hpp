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

/// How many reports a view shows in that state in the present run.
std::int64_t reports_in(const nlohmann::json& view, const std::string& state);

}  // namespace adit::simulation
