#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "forward/delivered_scene.hpp"
#include "forward/traffic_counts.hpp"
#include "forward/uri_pace.hpp"
#include "icd/mapping.hpp"
#include "icd/status.hpp"
#include "journal/journal.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "queues/marker_queue.hpp"
#include "queues/stamps.hpp"
#include "settings/settings.hpp"

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

  MarkerArrivals(loop::Loop& loop, loop::Workers& workers, journal::Journal& journal,
                 queues::MarkerQueue& queue, TrafficCounts& counts);

  void accept(icd::MarkersUpdate update, queues::Upload upload, Done done);

  /// True while an update is in the journal, perhaps partly, and not yet whole in the queue. Do not send.
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

  void run_step(Step step) noexcept {
    if ((this->*step)(arrivals_.front())) end();
  }
  Step next_step() const;
  bool begin(Arrival& arrival);
  /// The queue has no room for the whole update. True: some of its markers can be accepted.
  bool accept_known(Arrival& arrival);
  void make_records(const Arrival& arrival);
  bool keep(Arrival& arrival);
  bool add_part(Arrival& arrival);
  void free_unneeded();
  bool fail(Arrival& arrival, icd::Refusal why);
  void end();

  loop::Loop& loop_;
  loop::Workers& workers_;
  journal::Journal& journal_;
  queues::MarkerQueue& queue_;
  TrafficCounts& counts_;
  queues::OvertakenMarkers overtaken_;
  std::deque<Arrival> arrivals_;  // the first is in progress
  loop::Source next_turn_;
};

/// Markers: as States.
class Markers {
 public:
  /// A message in flight, which is not copied.
  using Sent = std::shared_ptr<const queues::QueuedMarkers>;
  static constexpr icd::Uri kUri = icd::Uri::MarkersUpdate;
  static constexpr const char* kMessages = "markers";
  static constexpr std::size_t kAtOnce = 500;  // markers to write or to show in one turn
  /// Joint failures before fewer markers are sent in a message, or each robot's state alone.
  static constexpr int kTriesTogether = 3;

  /// All outlive this.
  Markers(loop::Loop& loop, loop::Workers& workers, const settings::Settings& settings, TrafficCounts& counts,
          std::mt19937_64& random, journal::Journal& journal, DeliveredScene& delivered);

  void restore(const journal::HandoverState& carried);
  void on_settings_changed(const settings::Settings& settings);
  void on_new_command_post();
  void accept(icd::MarkersUpdate update, queues::Upload upload, MarkerArrivals::Done done) {
    arrivals_.accept(std::move(update), std::move(upload), std::move(done));
  }
  bool resend(icd::MarkersUpdate markers);

  UriPace& pace() { return pace_; }
  std::size_t count() const { return queue_.count(); }
  std::optional<loop::Instant> oldest() const { return queue_.oldest(); }
  /// nullopt: nothing may be sent, perhaps because an update is only partly in the queue.
  std::optional<loop::Instant> oldest_to_send() const {
    return arrivals_.is_in_part() ? std::nullopt : queue_.oldest();
  }
  /// The next message, stamped and journaled as sent: sent_message() until on_answered(). Null: none.
  Sent pop();
  const Sent& sent_message() const { return under_way_; }
  static icd::ChunkedBytes body_of(const queues::QueuedMarkers& markers);
  static std::vector<Traffic> traffic_of(const queues::QueuedMarkers&) {
    return {{TrafficKind::Markers, ""}};
  }

  void on_answered() { under_way_.reset(); }
  void on_passed(const queues::QueuedMarkers& markers);
  /// The markers are shown by show_some(), some in each turn.
  void show(const Sent& markers);
  /// Call before sending. True: the markers were too many for one turn, and the turn is over.
  bool show_some();
  /// True if no update arrives and all delivered markers are shown.
  bool is_idle() const { return arrivals_.empty() && !to_show_; }
  void finish(const queues::QueuedMarkers& markers, bool is_done) {
    if (!markers.is_ahead) journal_.record_markers_answered(is_done);
  }
  void put_back(const queues::QueuedMarkers& markers);
  bool is_on_trial(const queues::QueuedMarkers& markers) const;
  bool is_to_blame(const queues::QueuedMarkers& markers, bool may_reject);
  /// True: the marker is to be rejected. False: several are queued again, fewer to a message.
  bool give_up(const queues::QueuedMarkers& markers);

 private:
  loop::Loop& loop_;
  TrafficCounts& counts_;
  journal::Journal& journal_;
  DeliveredScene& delivered_;
  UriPace pace_;
  queues::MarkerQueue queue_;
  MarkerArrivals arrivals_;
  Sent under_way_;         // null: not in flight
  Sent to_show_;           // null: all are shown
  std::size_t shown_ = 0;  // of to_show_
  queues::Blame blame_;
  std::map<std::pair<std::string, std::int32_t>, queues::Trial> trials_;  // by ns and id
  int failed_ = 0;                                                        // as States
};

}  // namespace adit::forward
