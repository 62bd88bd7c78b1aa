#pragma once

#include <vector>

#include "alarms/alarm.hpp"
#include "alarms/facts.hpp"

/// The parts of conditions_of(), one for each side of the box.
namespace adit::alarms {

using Found = std::vector<Condition>;

void find_post_troubles(const Facts& facts, Found& found);
void find_network_troubles(const Facts& facts, Found& found);
void find_robot_troubles(const Facts& facts, Found& found);
void find_report_troubles(const Facts& facts, Found& found);
void find_box_troubles(const Facts& facts, Found& found);

}  // namespace adit::alarms
