#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "simulation/messages.hpp"

namespace adit::simulation {

using Json = nlohmann::json;

Json header_of(double stamp);  // 0: without one
double stamp_of(const Json& message);
Json pose_at(double x, double y, const Style& style);

/// The body of any message.
Json message_of(const Posting& posting, const Style& style);
/// The value of a grid's cell at that place, in half cells: of each grid another one, so that it shows whose
/// cell it is.
int value_of(std::int64_t serial, int x, int y);
/// Of a map.
Json map_of(const std::vector<Item>& items, const Style& style);
/// What it says: a grid, or each of the clouds that were merged into it.
std::vector<Item> map_items(const Json& message);

}  // namespace adit::simulation
