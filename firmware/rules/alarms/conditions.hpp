#pragma once

#include <vector>

#include "alarms/alarm.hpp"
#include "facts/snapshot.hpp"

namespace adit::alarms {

/// All conditions, for page, lights, `adit` and metrics. A condition that follows from a larger cause is
/// counted in that cause's `hides` and is not listed. Order: bad, ask, wait.
std::vector<Condition> conditions_of(const facts::Snapshot& snapshot);

/// Its parts, one for each side of the box.
using Conditions = std::vector<Condition>;
void find_command_post_troubles(const facts::Traffic& traffic, Conditions& found);
void find_network_troubles(const facts::Network& network, const facts::Traffic& traffic, Conditions& found);
void find_robot_troubles(const facts::Traffic& traffic, const facts::Clients& clients, Conditions& found);
void find_report_troubles(const facts::Reports& reports, Conditions& found);
void find_box_troubles(const facts::Box& box, Conditions& found);

/// Reports left at which the alarm starts.
inline constexpr std::int64_t kFewReports = 5;
/// Share of the queue's room at which the alarm starts.
inline constexpr double kNearlyFull = 0.8;
/// Free bytes on the ledger's disk below which the alarm starts.
inline constexpr std::uint64_t kLeastFree = 1u << 20;
/// An eMMC's wear (host::Wear) from which the alarm starts: 90 % of its life, 80 % of its spare blocks.
inline constexpr unsigned kWornLife = 10, kWornSpares = 2;
/// Most reports of one state that have a condition each; more share one.
inline constexpr std::size_t kOneByOne = 10;

}  // namespace adit::alarms
