#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "forward/traffic_counts.hpp"
#include "icd/markers_update.hpp"
#include "icd/status.hpp"
#include "journal/journal.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "queues/marker_queue.hpp"
#include "queues/overtaken.hpp"

namespace adit::forward {

/// Markers updates on their way into the queue, one at a time and whole: first the journal, then the queue.
/// For large updates a worker makes the records, and both take several turns of the loop. Changes that newer
/// ones overtook are left out first (queues::Upload).
class MarkerArrivals {
 public:
  /// 429: the queue is full; 503: it cannot be stored. A full queue still accepts changes of queued markers.
  /// Then the refusal counts the others.
  using Done = std::function<void(icd::Checked<void>)>;
  /// Larger updates need a worker; bytes as in icd::bytes_of.
  static constexpr std::size_t kSmall = 128u << 10;
  static constexpr std::size_t kPart = 500;  // markers per turn

  /// `came` is called after each update.
  MarkerArrivals(loop::Loop& loop, loop::Workers& workers, journal::Journal& journal,
                 queues::MarkerQueue& queue, TrafficCounts& counts, std::function<void()> came);

  void take(icd::MarkersUpdate update, queues::Upload upload, Done done);

  /// True while an update is in the journal, perhaps not yet whole, and not yet whole in the queue. Do not
  /// send then.
  bool is_in_part() const { return !empty() && arrivals_.front().is_kept; }
  bool empty() const { return arrivals_.empty(); }

 private:
  struct Arrival {
    std::shared_ptr<icd::MarkersUpdate> update;
    queues::Upload upload;
    Done done;
    icd::Checked<void> outcome = {};
    std::vector<std::string> records = {};                                // of the journal
    std::size_t stored = 0;                                               // of these
    bool is_kept = false;                                                 // at least in part, in the journal
    std::size_t added = 0;                                                // markers in the queue
    queues::MarkerChanges::Place last = queues::QueuedUpdates::kNowhere;  // place of the last one
  };
  /// True: the outcome is known.
  using Step = bool (MarkerArrivals::*)(Arrival&);

  void go(Step step) noexcept;
  Step next_step() const;
  bool begin(Arrival& arrival);
  /// The queue has no room for the whole update. True: some of its markers can be accepted.
  bool takes_some(Arrival& arrival);
  void make_records(const Arrival& arrival);
  bool keep(Arrival& arrival);
  bool add_part(Arrival& arrival);
  void free_needless();
  bool fail(Arrival& arrival, icd::Refusal why);
  void end();

  loop::Loop& loop_;
  loop::Workers& workers_;
  journal::Journal& journal_;
  queues::MarkerQueue& queue_;
  TrafficCounts& counts_;
  std::function<void()> came_;
  queues::OvertakenMarkers overtaken_;
  std::deque<Arrival> arrivals_;  // the first is in progress
  loop::Source next_turn_;
};

}  // namespace adit::forward
