#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "simulation/history.hpp"

namespace adit::simulation {

/// The difference between a view of the page and the panel's lights, or the status that systemd has; "" if
/// there is none. `count`: the number of events before the view.
std::string disagreement(const nlohmann::json& view, const std::vector<Event>& events, std::size_t count);

bool calls(const nlohmann::json& alarm);
std::string alarm_line(const nlohmann::json& alarm);

/// The number of reports in that state in the view's current run.
std::int64_t reports_in(const nlohmann::json& view, const std::string& state);

}  // namespace adit::simulation
