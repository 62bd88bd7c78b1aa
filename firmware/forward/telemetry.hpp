#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "forward/as_forwarded.hpp"
#include "forward/channel.hpp"
#include "forward/marker_arrivals.hpp"
#include "forward/record.hpp"
#include "forward/rejected.hpp"
#include "forward/uri_pace.hpp"
#include "icd/status.hpp"
#include "lanes/marker_lane.hpp"
#include "lanes/stamps.hpp"
#include "lanes/state_lane.hpp"

namespace adit::forward {

/// Robots' states and markers on their way to the mapping endpoint, on one connection of their own, whichever
/// has the older news first.
class Telemetry {
 public:
  /// `as_forwarded` is told what the Command Post took. What is accepted is in the journal first, until then.
  Telemetry(loop::Loop& loop, loop::Workers& workers, const settings::Settings& settings,
            std::optional<icd::BearerToken> token, Record& record, RejectedStore& rejected,
            std::mt19937_64& random, journal::Journal& journal, AsForwarded& as_forwarded);

  /// Takes up what the lives before have left.
  void carry_on(const journal::Carried& carried);
  /// As if something had just been sent, by whoever sent before.
  void hold_back() {
    state_pace_.sent(loop_.now());
    markers_pace_.sent(loop_.now());
  }
  /// Of states, of which the operator's test sends one that is refused.
  UriPace& state_pace() { return state_pace_; }
  /// The settings are others, by which it goes from now on.
  void settings_changed();
  /// The endpoint is, or its token, or the way there: what is under way to another place is given up, and
  /// sent again to this one.
  void endpoint_changed(std::optional<icd::BearerToken> token);
  /// Before start(): connects to nobody, and sends nothing.
  void stand_by() { stopping_ = true; }
  void start() {
    if (stopping_) return;
    channel_.keep_warm();
    pump();
  }
  /// An error of 429: the lane is full.
  icd::Checked<void> has_room_for(const icd::StateUpdate& update);
  /// A state for which there is room. An error of 503: it cannot be kept.
  icd::Checked<void> take(const std::vector<lanes::PostedPose>& poses, std::size_t bytes_received) noexcept;
  /// Stamps are on the gateway's clock. Refused with 429 where the lane is full, and with 503 where it cannot
  /// be kept.
  void take(icd::MarkersUpdate update, std::size_t bytes_received, MarkerArrivals::Done done) {
    arrivals_.take(std::move(update), bytes_received, std::move(done));
  }

  /// Another run is on: it is told of no robot that has not posted since, but for news that waits.
  void change_run() { state_.begin_run(); }

  /// What was rejected, on the operator's word: before what came since, and not what that says more than.
  /// Not a map. False: it stays aside, for it is not kept, or newer markers that it would delete are under
  /// way, or some come in just now.
  bool send_again(const lanes::Message& message);

  /// Sends nothing more. False while an answer is still awaited.
  bool stop();
  /// The cable is: nothing waits any more for what failed without it.
  void link_is_back();
  const Channel& channel() const { return channel_; }
  std::size_t waiting(Kind kind) const;
  /// When the oldest news that waits or is under way was accepted; nothing if there is none. Of a robot's
  /// state, at the latest: robots go together.
  std::optional<loop::Instant> waits_since(const Traffic& traffic) const;

 private:
  void pump() noexcept;
  void endpoint_turned();
  void send_next();
  void send_state();
  void send_markers();
  /// Those under way leave; many do so in a turn of their own.
  void write_markers();
  /// What is under way, and is not copied.
  template <class Waiting>
  using Shared = std::shared_ptr<const Waiting>;
  template <class Waiting>
  void answered(Kind kind, UriPace& pace, const Shared<Waiting>& sent, std::size_t bytes,
                const uplink::Outcome& outcome);
  /// Whose news it has: what goes along unchanged counts for nobody.
  std::vector<Traffic> traffic_of(const lanes::WaitingState& state) const;
  std::vector<Traffic> traffic_of(const lanes::WaitingMarkers& markers) const;
  void put_back(const lanes::WaitingState& state) {
    journal_.state_answered(false);
    state_.put_back(state);
  }
  void put_back(const lanes::WaitingMarkers& markers) {
    if (markers.is_ahead) return;
    journal_.markers_answered(false);
    markers_.put_back(markers);
  }
  /// They need no more care.
  void done(const lanes::WaitingState&) { journal_.state_answered(true); }
  void done(const lanes::WaitingMarkers& markers) {
    if (!markers.is_ahead) journal_.markers_answered(true);
  }

  template <class Waiting>
  void judge(Kind kind, UriPace& pace, const Shared<Waiting>& sent, std::size_t bytes,
             const uplink::Outcome& outcome);
  void passed(const lanes::WaitingState& state);
  void passed(const lanes::WaitingMarkers& markers);
  /// What the Command Post has taken, to as_forwarded_.
  void show(const Shared<lanes::WaitingState>& state);
  void show(const Shared<lanes::WaitingMarkers>& markers);
  /// Before anything more is sent. False: that was all, at once; otherwise the turn is over.
  bool show_some();
  /// It is done once what it replaced is written down as replaced: the other way round, a kill in between
  /// would leave a life to come that knows of neither, and lets an operator send the older one.
  template <class Waiting>
  void replace(const Shared<Waiting>& sent);
  /// Refused, or failed alone: the one at fault is looked for among several, and rejected by itself.
  void give_up(const lanes::WaitingState& state, int status, const std::string& sentence, std::size_t bytes);
  void give_up(const lanes::WaitingMarkers& markers, int status, const std::string& sentence,
               std::size_t bytes);
  void set_aside(const lanes::Message& message, int status, const std::string& sentence, std::size_t bytes,
                 std::function<void(bool kept)> told);
  /// The handler failed: true where it is this message's fault, and else it is put back.
  bool is_to_blame(const lanes::WaitingState& state);
  bool is_to_blame(const lanes::WaitingMarkers& markers);
  bool wait_again(const icd::StateUpdate& state);
  bool wait_again(icd::MarkersUpdate markers);
  bool wait_again(const icd::MapUpdate&) { return false; }

  loop::Loop& loop_;
  const settings::Settings& settings_;
  Record& record_;
  RejectedStore& rejected_;
  journal::Journal& journal_;
  AsForwarded& as_forwarded_;
  Channel channel_;
  UriPace state_pace_, markers_pace_;
  loop::Source wake_;
  lanes::StateLane state_;
  lanes::MarkerLane markers_;
  MarkerArrivals arrivals_;
  Shared<lanes::WaitingMarkers> markers_under_way_;  // null: none
  Shared<lanes::WaitingMarkers> to_show_;            // null: all are shown
  std::size_t shown_ = 0;                            // of these
  lanes::StampOrder state_stamps_, marker_stamps_;
  int state_failed_ = 0, markers_failed_ = 0;  // answers in a row of a handler that failed
  lanes::Blame state_blame_, marker_blame_;
  std::map<std::pair<std::string, std::int32_t>, lanes::Trial> marker_trials_;  // by ns and id
  std::optional<std::pair<Kind, loop::Instant>> under_way_;  // and when its oldest news was accepted
  bool rejected_writes_ = false;  // nothing is sent meanwhile: the journal knows of one answer at a time
  bool stopping_ = false;
};

}  // namespace adit::forward
