#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "dispatch/output.hpp"
#include "simulation/history.hpp"
#include "simulation/reader.hpp"

namespace adit::simulation {

constexpr double kLongestDoubt = 60;  // seconds

/// What both sides saw, and the contents of the box at the end, long after the last fault.
struct Evidence {
  const std::vector<Event>& events;
  const std::vector<dispatch::Report>& reports;  // of the ledger
  const std::vector<Reading>& readings;          // of the page
  std::size_t most_map_bytes = 0;                // limit of queued maps in the first settings
  std::size_t missing = 0;                       // records missing in the ledger
};

/// The window of the world's clock for a span from `first` to `last` of the box's clock. A power cut may
/// set the box's clock back; if anything else set it, the window is unbounded.
struct Window {
  double first = 0, last = 0;
  bool has(double at) const { return at > first && at < last; }
};
Window window_of(const Evidence& evidence, double first, double last);

/// Each check adds a sentence for each violation, which begins with the check's name. README.md has the
/// rules.
using Broken = std::vector<std::string>;
void settings_kept(const Evidence& evidence, Broken& broken);
void starts(const Evidence& evidence, Broken& broken);
void once(const Evidence& evidence, Broken& broken);
void addressed(const Evidence& evidence, Broken& broken);
void not_lost(const Evidence& evidence, Broken& broken);
void paced(const Evidence& evidence, Broken& broken);
void reports_go_first(const Evidence& evidence, Broken& broken);
void status_keeps_away(const Evidence& evidence, Broken& broken);
void status_has_its_turn(const Evidence& evidence, Broken& broken);
void learned(const Evidence& evidence, Broken& broken);
void others_go_on(const Evidence& evidence, Broken& broken);
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
void decided(const Evidence& evidence, Broken& broken);
void live(const Evidence& evidence, Broken& broken);
void not_cut(const Evidence& evidence, Broken& broken);
void honest(const Evidence& evidence, Broken& broken);
void lights(const Evidence& evidence, Broken& broken);
void obeyed(const Evidence& evidence, Broken& broken);
void bounded(const Evidence& evidence, Broken& broken);
void older_copy(const Evidence& evidence, Broken& broken);
void has_room(const Evidence& evidence, Broken& broken);
void alive(const Evidence& evidence, Broken& broken);

/// The faults of the disk so far. Events are added in their order.
class DiskFaultsSeen {
 public:
  void add(const Event& event);
  /// Whether a gateway begins without state in the runtime directory: the one before could not write it, or
  /// this one cannot read it.
  bool forgets_at(const Event& event) const;
  /// Whether a fault is present, or ended less than `seconds` ago.
  bool within(double seconds, double now) const;

 private:
  std::set<std::string> on_;
  bool forgets_ = false;
  double last_ = -1e9;
};

/// Older copies of the ledger that were put back and lack records. The number of the last record outside
/// the ledger tells that. It has each step at once in memory, which a power cut clears, and later on the
/// disk.
class OlderCopies {
 public:
  struct PutBack {
    double copied = 0;       // when the copy was made
    double ended = 0;        // the process before
    double at = 0;           // when the copy was put back
    double known_until = 0;  // Adit must find that steps of a time up to this one are missing
    double on_disk = 0;      // the same, by the disk alone
  };
  explicit OlderCopies(const std::vector<Event>& events);
  const std::vector<PutBack>& all() const { return all_; }
  /// The copy that may have taken a step of this time, or null.
  const PutBack* taken_by(double step) const;
  /// Whether a step of this time may be missing at `now`, and Adit may not know that.
  bool may_forget(double step, double now) const;

 private:
  std::vector<PutBack> all_;
};
/// The reports that Adit has sent, by serial.
struct SentReports {
  SentReports(const std::vector<Event>& events, const OlderCopies& copies);
  std::map<std::int64_t, double> kept;  // must be in the ledger, with the time when each was sent
  std::set<std::int64_t> lost;          // Adit must find that they are missing
};
/// A record of a report that Adit has not sent, or has forgotten.
bool is_anothers(const Event& event, const OlderCopies& copies);
std::int64_t serial_of(const dispatch::Report& report);

Broken all_checks(const Evidence& evidence);

}  // namespace adit::simulation
