#pragma once

#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "forward/channel.hpp"
#include "forward/markers.hpp"
#include "forward/rejected.hpp"
#include "forward/states.hpp"

namespace adit::forward {

/// States and markers to the mapping endpoint on one connection, oldest first.
class Telemetry {
 public:
  /// `delivered` gets delivered messages. Until then the journal has them.
  Telemetry(loop::Loop& loop, uplink::Servers& servers, loop::Workers& workers,
            const settings::Settings& settings, std::optional<icd::BearerToken> token, TrafficCounts& counts,
            RejectedStore& rejected, std::mt19937_64& random, journal::Journal& journal,
            DeliveredScene& delivered);

  /// Restores the messages of earlier processes.
  void carry_on(const journal::Carried& carried);
  /// As if messages had just been sent.
  void hold_back() {
    states_.pace().sent(loop_.now());
    markers_.pace().sent(loop_.now());
  }
  /// For the operator's test, which sends one rejected state.
  UriPace& state_pace() { return states_.pace(); }
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
  icd::Checked<void> has_room_for(const icd::StateUpdate& update) { return states_.has_room_for(update); }
  /// A state for which there is room. 503: it cannot be stored.
  icd::Checked<void> take(const std::vector<queues::PostedPose>& poses, std::size_t bytes_received) noexcept;
  /// Stamps are on the stamp clock. 429: the queue is full; 503: it cannot be stored.
  void take(icd::MarkersUpdate update, queues::Upload upload, MarkerArrivals::Done done) {
    markers_.take(std::move(update), std::move(upload), std::move(done));
  }

  /// Another run is on. It gets robots that post in it, and queued news.
  void change_run() { states_.begin_run(); }

  /// Queues a rejected message before later ones, without parts that they contain. Not for maps. False: it
  /// stays rejected, because it cannot be stored, it would delete markers in flight, or markers are arriving.
  bool send_again(const queues::Message& message);

  /// Stops sending. False while an answer is awaited.
  bool stop();
  /// The cable is in again: retries at once.
  void link_is_back();
  const Channel& channel() const { return channel_; }
  std::size_t waiting(Kind kind) const;
  /// When the robot's pose, or the oldest change of a marker, was accepted that is queued or in flight.
  std::optional<loop::Instant> waits_since(const Traffic& traffic) const;

 private:
  void pump() noexcept;
  void send_next();
  void send_state();
  void send_markers();
  // `Of`: States or Markers, whose message is sent.
  template <class Of>
  void send(Of& of, const typename Of::Sent& sent);
  template <class Of>
  void answered(Of& of, const typename Of::Sent& sent, std::size_t bytes, const uplink::Outcome& outcome);
  template <class Of>
  void classify(Of& of, const typename Of::Sent& sent, std::size_t bytes, const uplink::Outcome& outcome);
  /// Finishes `sent` after its rejected predecessors are marked. Otherwise a kill could leave both unmarked,
  /// and an operator could send the older one.
  template <class Of>
  void replace(Of& of, const typename Of::Sent& sent);
  /// Rejects a single message. Among several it looks for the one at fault.
  template <class Of>
  void give_up(Of& of, const typename Of::Sent& sent, int status, const std::string& sentence,
               std::size_t bytes);

  loop::Loop& loop_;
  const settings::Settings& settings_;
  TrafficCounts& counts_;
  RejectedStore& rejected_;
  Channel channel_;
  loop::Source wake_;
  States states_;
  Markers markers_;
  bool rejected_writes_ = false;  // do not send: the journal has one answer at a time
  bool stopping_ = false;
};

}  // namespace adit::forward
