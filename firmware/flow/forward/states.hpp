#pragma once

#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "forward/delivered_scene.hpp"
#include "forward/traffic_counts.hpp"
#include "forward/uri_pace.hpp"
#include "queues/state_queue.hpp"
#include "settings/settings.hpp"

namespace adit::forward {

/// The states: accepts them, chooses the next message, and handles the verdict of its answer. Telemetry sends
/// it.
class States {
 public:
  /// A message in flight, which is not copied.
  using Sent = std::shared_ptr<const queues::QueuedState>;
  static constexpr icd::Uri kUri = icd::Uri::StateUpdate;
  static constexpr const char* kMessages = "robots' states";
  /// Joint failures before each robot's state is sent alone, or fewer markers in a message.
  static constexpr int kTriesTogether = 3;

  /// `delivered` gets delivered states. Until then the journal has them. All outlive this.
  States(loop::Loop& loop, const settings::Settings& settings, TrafficCounts& counts, std::mt19937_64& random,
         journal::Journal& journal, DeliveredScene& delivered);

  void carry_on(const journal::Carried& carried);
  /// Another Command Post knows no robots yet.
  void endpoint_turned();
  /// Telemetry::change_run(), has_room_for(), take() and send_again().
  void begin_run() { queue_.begin_run(); }
  icd::Checked<void> has_room_for(const icd::StateUpdate& update);
  icd::Checked<void> accept(const std::vector<queues::PostedPose>& poses, std::size_t bytes_received);
  bool send_again(const icd::StateUpdate& state);

  UriPace& pace() { return pace_; }
  bool empty() const { return queue_.empty(); }
  /// StateQueue::next()
  std::optional<queues::StateQueue::Next> next() const { return queue_.next(loop_.now()); }
  /// When the robot's pose was accepted that is queued or in flight.
  std::optional<loop::Instant> accepted_at(const std::string& robot) const;
  /// The next message, stamped and journaled as sent. Null: none.
  Sent take();
  static icd::ChunkedBytes body_of(const queues::QueuedState& state);
  /// Robots with news. Repeated poses do not count.
  static std::vector<Traffic> traffic_of(const queues::QueuedState& state);

  void passed(const queues::QueuedState& state);
  /// Passes an accepted message to delivered.
  void show(const Sent& state);
  /// Journals the answer. `is_done`: the message is not sent again.
  void finish(const queues::QueuedState&, bool is_done) { journal_.state_answered(is_done); }
  void put_back(const queues::QueuedState& state);
  /// Whether a state of this robot failed alone before while others passed.
  bool is_on_trial(const queues::QueuedState& state);
  /// After an answer that may concern a part of the message. True: the message is at fault. False: it is
  /// queued again. `may_reject`: as Blame::failed().
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

}  // namespace adit::forward
