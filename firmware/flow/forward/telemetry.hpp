#pragma once

#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "forward/channel.hpp"
#include "forward/delivered_scene.hpp"
#include "forward/markers.hpp"
#include "forward/rejected.hpp"
#include "forward/traffic_counts.hpp"
#include "forward/uri_pace.hpp"
#include "queues/state_queue.hpp"
#include "settings/settings.hpp"

namespace adit::forward {

/// The states: accepts them, chooses the next message, and handles the verdict. Telemetry sends it.
class States {
 public:
  /// A message in flight, which is not copied.
  using Sent = std::shared_ptr<const queues::QueuedState>;
  static constexpr icd::Uri kUri = icd::Uri::StateUpdate;
  static constexpr const char* kMessages = "robots' states";

  /// `delivered` gets delivered states. Until then the journal has them. All outlive this.
  States(loop::Loop& loop, const settings::Settings& settings, TrafficCounts& counts, std::mt19937_64& random,
         journal::Journal& journal, DeliveredScene& delivered);

  void restore(const journal::HandoverState& carried);
  /// Another Command Post knows no robots yet.
  void on_new_command_post();
  /// Telemetry::change_run(), has_room_for(), accept() and resend().
  void begin_run() { queue_.begin_run(); }
  icd::Checked<void> has_room_for(const icd::StateUpdate& update);
  icd::Checked<void> accept(const std::vector<queues::PostedPose>& poses, std::size_t bytes_received);
  bool resend(const icd::StateUpdate& state);

  UriPace& pace() { return pace_; }
  bool empty() const { return queue_.empty(); }
  std::optional<queues::StateQueue::NextState> next() const { return queue_.next(loop_.now()); }
  /// When the robot's pose was accepted that is queued or in flight.
  std::optional<loop::Instant> accepted_at(const std::string& robot) const;
  /// The next message, stamped and journaled as sent. Null: none.
  Sent pop();
  static icd::ChunkedBytes body_of(const queues::QueuedState& state);
  /// Robots with news. Repeated poses do not count.
  static std::vector<Traffic> traffic_of(const queues::QueuedState& state);

  void on_passed(const queues::QueuedState& state);
  /// Passes an accepted message to delivered.
  void show(const Sent& state) { delivered_.on_forwarded(state->news, loop_.wall_now()); }
  /// Journals the answer. `is_done`: the message is not sent again.
  void finish(const queues::QueuedState&, bool is_done) { journal_.record_state_answered(is_done); }
  void put_back(const queues::QueuedState& state);
  /// Whether a state of this robot failed alone before while others passed.
  bool is_on_trial(const queues::QueuedState& state);
  /// After an answer that may concern a part of the message. True: the message is at fault. False: it is
  /// queued again. `may_reject`: as Blame::on_failed().
  bool is_to_blame(const queues::QueuedState& state, bool may_reject);
  /// True: the message is to be rejected. False: several poses are queued again, each alone, or the pose was
  /// delivered before.
  bool give_up(const queues::QueuedState& state);

 private:
  loop::Loop& loop_;
  TrafficCounts& counts_;
  journal::Journal& journal_;
  DeliveredScene& delivered_;
  UriPace pace_;
  queues::StateQueue queue_;
  queues::Blame blame_;
  int failed_ = 0;  // answers that may concern a part of a message, since a message passed
};

/// States and markers to the mapping endpoint on one connection, oldest first.
class Telemetry {
 public:
  /// `delivered` gets delivered messages. Until then the journal has them.
  Telemetry(loop::Loop& loop, uplink::Servers& servers, loop::Workers& workers,
            const settings::Settings& settings, std::optional<icd::BearerToken> token, TrafficCounts& counts,
            RejectedStore& rejected, std::mt19937_64& random, journal::Journal& journal,
            DeliveredScene& delivered);

  /// Restores the messages of earlier processes.
  void restore(const journal::HandoverState& carried);
  void assume_just_sent() {
    states_.pace().on_sent(loop_.now());
    markers_.pace().on_sent(loop_.now());
  }
  /// For the operator's test, which sends one rejected state.
  UriPace& state_pace() { return states_.pace(); }
  void on_settings_changed();
  /// Requests to another address or token are given up and retried at the new one.
  void on_endpoint_changed(std::optional<icd::BearerToken> token);
  /// Before start(): opens no connection and sends no request.
  void set_standby() { stopping_ = true; }
  void start() {
    if (stopping_) return;
    channel_.keep_warm();
    pump();
  }
  /// 429: too many robots.
  icd::Checked<void> has_room_for(const icd::StateUpdate& update) { return states_.has_room_for(update); }
  /// A state for which there is room. 503: it cannot be stored.
  icd::Checked<void> accept(const std::vector<queues::PostedPose>& poses,
                            std::size_t bytes_received) noexcept;
  /// Stamps are on the stamp clock. 429: the queue is full; 503: it cannot be stored.
  void accept(icd::MarkersUpdate update, queues::Upload upload, MarkerArrivals::Done done) {
    markers_.accept(std::move(update), std::move(upload),
                    [this, done = std::move(done)](icd::Checked<void> outcome) {
                      done(std::move(outcome));
                      pump();
                    });
  }

  /// Another run is on. It gets robots that post in it, and queued news.
  void change_run() { states_.begin_run(); }

  /// Queues a rejected message before later ones, without parts that they contain. Not for maps. False: it
  /// stays rejected, because it cannot be stored, it would delete markers in flight, or markers are arriving.
  bool resend(const queues::Message& message);

  /// Stops sending. False while an answer is awaited.
  bool stop();
  /// The cable is in again: retries at once.
  void on_link_up();
  const Channel& channel() const { return channel_; }
  std::size_t waiting(TrafficKind kind) const;
  /// When the robot's pose, or the oldest change of a marker, was accepted that is queued or in flight.
  std::optional<loop::Instant> oldest_acceptance(const Traffic& traffic) const;

 private:
  void pump() noexcept;
  void send_next();
  void send_markers();
  // `Of`: States or Markers, whose message is sent.
  template <class Of>
  void send(Of& of, const typename Of::Sent& sent);
  template <class Of>
  void on_answered(Of& of, const typename Of::Sent& sent, std::size_t bytes, const uplink::Outcome& outcome);
  template <class Of>
  void classify(Of& of, const typename Of::Sent& sent, std::size_t bytes, const uplink::Outcome& outcome);
  /// Finishes `sent` after its rejected predecessors are marked, so that no kill lets an operator send those.
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
