#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "simulation/messages.hpp"

namespace adit::simulation {

using Json = nlohmann::json;

Json header_of(double stamp);  // 0: without a stamp
double stamp_of(const Json& message);
Json pose_at(double x, double y, const Style& style);

/// The body of a message of any kind.
Json message_of(const Posting& posting, const Style& style);
/// The value of a grid's cell (an extent of one cell). Each grid has other values, so that a cell shows its
/// grid.
int value_of(std::int64_t serial, const Extent& cell);
/// The body of a map.
Json map_of(const std::vector<Item>& items, const Style& style);
/// The grid, or each of the clouds that were merged into the message.
std::vector<Item> map_items(const Json& message);

}  // namespace adit::simulation
