#pragma once

#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "forward/delivered_scene.hpp"
#include "forward/marker_arrivals.hpp"
#include "forward/uri_pace.hpp"
#include "settings/settings.hpp"

namespace adit::forward {

/// Markers: as States.
class Markers {
 public:
  /// A message in flight, which is not copied.
  using Sent = std::shared_ptr<const queues::QueuedMarkers>;
  static constexpr icd::Uri kUri = icd::Uri::MarkersUpdate;
  static constexpr const char* kMessages = "markers";
  static constexpr std::size_t kAtOnce = 500;  // markers to write or to show in one turn

  /// `came` is called after each arrival. All outlive this.
  Markers(loop::Loop& loop, loop::Workers& workers, const settings::Settings& settings, TrafficCounts& counts,
          std::mt19937_64& random, journal::Journal& journal, DeliveredScene& delivered,
          std::function<void()> came);

  void carry_on(const journal::Carried& carried);
  void settings_changed(const settings::Settings& settings);
  void endpoint_turned();
  void take(icd::MarkersUpdate update, queues::Upload upload, MarkerArrivals::Done done) {
    arrivals_.take(std::move(update), std::move(upload), std::move(done));
  }
  bool send_again(icd::MarkersUpdate markers);

  UriPace& pace() { return pace_; }
  std::size_t count() const { return queue_.count(); }
  std::optional<loop::Instant> oldest() const { return queue_.oldest(); }
  /// nullopt: nothing may be sent, perhaps because an update is only partly in the queue.
  std::optional<loop::Instant> oldest_to_send() const {
    return arrivals_.is_in_part() ? std::nullopt : queue_.oldest();
  }
  /// The next message, stamped and journaled as sent: under_way() until answered(). Null: none.
  Sent take();
  const Sent& under_way() const { return under_way_; }
  static icd::ChunkedBytes body_of(const queues::QueuedMarkers& markers);
  static std::vector<Traffic> traffic_of(const queues::QueuedMarkers&) { return {{Kind::Markers, ""}}; }

  void answered() { under_way_.reset(); }
  void passed(const queues::QueuedMarkers& markers);
  /// The markers are shown by show_some(), some in each turn.
  void show(const Sent& markers);
  /// Call before sending. True: the markers were too many for one turn, and the turn is over.
  bool show_some();
  /// True if no update arrives and all delivered markers are shown.
  bool is_idle() const { return arrivals_.empty() && !to_show_; }
  void finish(const queues::QueuedMarkers& markers, bool is_done) {
    if (!markers.is_ahead) journal_.markers_answered(is_done);
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
