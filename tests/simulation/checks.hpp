#pragma once

#include <set>
#include <string>
#include <vector>

#include "dispatch/output.hpp"
#include "simulation/history.hpp"
#include "simulation/reader.hpp"

namespace adit::simulation {

constexpr double kLongestDoubt = 60;  // seconds

/// What both sides saw, and what the box holds in the end, long after the last fault.
struct Evidence {
  const std::vector<Event>& events;
  const std::vector<dispatch::Report>& reports;  // of the ledger
  const std::vector<Reading>& readings;          // of the page
  std::size_t most_map_bytes = 0;                // that wait at once, by the first settings
  std::size_t missing = 0;                       // records of the ledger
};

/// The window of the world's clock in which something was that the box has as from `first` to `last` by its
/// own: a power cut may set that back, and if somebody else set it, nothing is known.
struct Window {
  double first = 0, last = 0;
  bool has(double at) const { return at > first && at < last; }
};
Window window_of(const Evidence& evidence, double first, double last);

/// Each adds a sentence for what it finds broken, which begins with its name. Their rules are in README.md.
using Broken = std::vector<std::string>;
void settings_kept(const Evidence& evidence, Broken& broken);
void starts(const Evidence& evidence, Broken& broken);
void once(const Evidence& evidence, Broken& broken);
void not_lost(const Evidence& evidence, Broken& broken);
void paced(const Evidence& evidence, Broken& broken);
void reports_go_first(const Evidence& evidence, Broken& broken);
void status_keeps_away(const Evidence& evidence, Broken& broken);
void learned(const Evidence& evidence, Broken& broken);
void stamps(const Evidence& evidence, Broken& broken);
void kept(const Evidence& evidence, Broken& broken);
void answered(const Evidence& evidence, Broken& broken);
void pose_arrived(const Evidence& evidence, Broken& broken);
void grid_arrived(const Evidence& evidence, Broken& broken);
void cloud_arrived(const Evidence& evidence, Broken& broken);
void markers_arrived(const Evidence& evidence, Broken& broken);
void refused(const Evidence& evidence, Broken& broken);
void clean(const Evidence& evidence, Broken& broken);
void status_true(const Evidence& evidence, Broken& broken);
void live(const Evidence& evidence, Broken& broken);
void not_cut(const Evidence& evidence, Broken& broken);
void honest(const Evidence& evidence, Broken& broken);
void lights(const Evidence& evidence, Broken& broken);
void obeyed(const Evidence& evidence, Broken& broken);
void bounded(const Evidence& evidence, Broken& broken);
void has_room(const Evidence& evidence, Broken& broken);
void alive(const Evidence& evidence, Broken& broken);

/// Which faults of the disk there were, of events in their order.
class DiskFaultsSeen {
 public:
  void add(const Event& event);
  /// Whether a gateway begins after one that could not keep in the runtime folder what the next one is to
  /// know, or cannot read it itself.
  bool forgets_at(const Event& event) const;
  /// Any, now or less than so many seconds ago.
  bool within(double seconds, double now) const;

 private:
  std::set<std::string> on_;
  bool forgets_ = false;
  double last_ = -1e9;
};
std::int64_t serial_of(const dispatch::Report& report);

Broken all_checks(const Evidence& evidence);

}  // namespace adit::simulation
