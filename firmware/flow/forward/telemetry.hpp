#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "forward/channel.hpp"
#include "forward/delivered_scene.hpp"
#include "forward/marker_arrivals.hpp"
#include "forward/record.hpp"
#include "forward/rejected.hpp"
#include "forward/uri_pace.hpp"
#include "icd/status.hpp"
#include "queues/marker_queue.hpp"
#include "queues/stamps.hpp"
#include "queues/state_queue.hpp"

namespace adit::forward {

/// States and markers to the mapping endpoint on one connection, oldest first.
class Telemetry {
 public:
  /// `delivered` gets delivered messages. Until then the journal has them.
  Telemetry(loop::Loop& loop, loop::Workers& workers, const settings::Settings& settings,
            std::optional<icd::BearerToken> token, Record& record, RejectedStore& rejected,
            std::mt19937_64& random, journal::Journal& journal, DeliveredScene& delivered);

  /// Restores the messages of earlier processes.
  void carry_on(const journal::Carried& carried);
  /// As if messages had just been sent.
  void hold_back() {
    state_pace_.sent(loop_.now());
    markers_pace_.sent(loop_.now());
  }
  /// For the operator's test, which sends one rejected state.
  UriPace& state_pace() { return state_pace_; }
  void settings_changed();
  /// Requests to another address or token are given up and retried at the new one.
  void endpoint_changed(std::optional<icd::BearerToken> token);
  /// Before start(): opens no connection and sends no request.
  void stand_by() { stopping_ = true; }
  void start() {
    if (stopping_) return;
    channel_.keep_warm();
    pump();
  }
  /// 429: too many robots.
  icd::Checked<void> has_room_for(const icd::StateUpdate& update);
  /// A state for which there is room. 503: it cannot be stored.
  icd::Checked<void> take(const std::vector<queues::PostedPose>& poses, std::size_t bytes_received) noexcept;
  /// Stamps are on the stamp clock. 429: the queue is full; 503: it cannot be stored.
  void take(icd::MarkersUpdate update, std::size_t bytes_received, MarkerArrivals::Done done) {
    arrivals_.take(std::move(update), bytes_received, std::move(done));
  }

  /// Another run is on. It gets robots that post in it, and queued news.
  void change_run() { state_.begin_run(); }

  /// Queues a rejected message before later ones, without parts that they contain. Not for maps. False: it
  /// stays rejected, because it cannot be stored, it would delete markers in flight, or markers are arriving.
  bool send_again(const queues::Message& message);

  /// Stops sending. False while an answer is awaited.
  bool stop();
  /// The cable is in again: retries at once.
  void link_is_back();
  const Channel& channel() const { return channel_; }
  std::size_t waiting(Kind kind) const;
  /// When the oldest news, queued or in flight, was accepted. Robots go together, so one robot's state may be
  /// newer.
  std::optional<loop::Instant> waits_since(const Traffic& traffic) const;

 private:
  void pump() noexcept;
  void endpoint_turned();
  void send_next();
  void send_state();
  void send_markers();
  /// Sends the markers in flight. Many get a turn of their own.
  void write_markers();
  /// A message in flight, which is not copied.
  template <class Waiting>
  using Shared = std::shared_ptr<const Waiting>;
  template <class Waiting>
  void answered(Kind kind, UriPace& pace, const Shared<Waiting>& sent, std::size_t bytes,
                const uplink::Outcome& outcome);
  /// Robots with news. Repeated poses do not count.
  std::vector<Traffic> traffic_of(const queues::QueuedState& state) const;
  std::vector<Traffic> traffic_of(const queues::QueuedMarkers& markers) const;
  void put_back(const queues::QueuedState& state) {
    journal_.state_answered(false);
    state_.put_back(state);
  }
  void put_back(const queues::QueuedMarkers& markers) {
    if (markers.is_ahead) return;
    journal_.markers_answered(false);
    markers_.put_back(markers);
  }
  void done(const queues::QueuedState&) { journal_.state_answered(true); }
  void done(const queues::QueuedMarkers& markers) {
    if (!markers.is_ahead) journal_.markers_answered(true);
  }

  template <class Waiting>
  void classify(Kind kind, UriPace& pace, const Shared<Waiting>& sent, std::size_t bytes,
                const uplink::Outcome& outcome);
  void passed(const queues::QueuedState& state);
  void passed(const queues::QueuedMarkers& markers);
  /// Passes accepted messages to delivered_.
  void show(const Shared<queues::QueuedState>& state);
  void show(const Shared<queues::QueuedMarkers>& markers);
  /// Call before sending. True: the markers were too many for one turn, and the turn is over.
  bool show_some();
  /// Finishes `sent` after its rejected predecessors are marked. Otherwise a kill could leave both unmarked,
  /// and an operator could send the older one.
  template <class Waiting>
  void replace(const Shared<Waiting>& sent);
  /// Rejects a single message. Among several it looks for the one at fault.
  void give_up(const queues::QueuedState& state, int status, const std::string& sentence, std::size_t bytes);
  void give_up(const queues::QueuedMarkers& markers, int status, const std::string& sentence,
               std::size_t bytes);
  void set_aside(const queues::Message& message, int status, const std::string& sentence, std::size_t bytes,
                 std::function<void(bool kept)> told);
  /// True: the message is at fault. False: it is queued again.
  bool is_to_blame(const queues::QueuedState& state);
  bool is_to_blame(const queues::QueuedMarkers& markers);
  bool wait_again(const icd::StateUpdate& state);
  bool wait_again(icd::MarkersUpdate markers);
  bool wait_again(const icd::MapUpdate&) { return false; }

  loop::Loop& loop_;
  const settings::Settings& settings_;
  Record& record_;
  RejectedStore& rejected_;
  journal::Journal& journal_;
  DeliveredScene& delivered_;
  Channel channel_;
  UriPace state_pace_, markers_pace_;
  loop::Source wake_;
  queues::StateQueue state_;
  queues::MarkerQueue markers_;
  MarkerArrivals arrivals_;
  Shared<queues::QueuedMarkers> markers_under_way_;  // null: not in flight
  Shared<queues::QueuedMarkers> to_show_;            // null: all are shown
  std::size_t shown_ = 0;                            // of to_show_
  queues::StampOrder state_stamps_, marker_stamps_;
  int state_failed_ = 0, markers_failed_ = 0;  // successive handler failures
  queues::Blame state_blame_, marker_blame_;
  std::map<std::pair<std::string, std::int32_t>, queues::Trial> marker_trials_;  // by ns and id
  std::optional<std::pair<Kind, loop::Instant>> under_way_;  // and when its oldest news was accepted
  bool rejected_writes_ = false;  // do not send: the journal has one answer at a time
  bool stopping_ = false;
};

}  // namespace adit::forward
