#pragma once

#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "gateway/as_forwarded.hpp"
#include "gateway/channel.hpp"
#include "gateway/record.hpp"
#include "gateway/uri_pace.hpp"
#include "icd/status.hpp"
#include "lanes/marker_lane.hpp"
#include "lanes/stamps.hpp"
#include "lanes/state_lane.hpp"

namespace adit::gateway {

/// Robots' states and markers on their way to the mapping endpoint, on one connection of their own, whichever
/// has the older news first.
class News {
 public:
  /// `as_forwarded` is told what the Command Post took.
  News(loop::Loop& loop, const settings::Settings& settings, std::optional<icd::BearerToken> token,
       Record& record, std::mt19937_64& random, AsForwarded& as_forwarded);

  /// As if something had just been sent, by whoever sent before.
  void hold_back() {
    state_pace_.sent(loop_.now());
    markers_pace_.sent(loop_.now());
  }
  void start() { channel_.keep_warm(); }
  /// Stamps are on the gateway's clock. Refused with 429 where the lane is full.
  icd::Checked<void> take(const icd::StateUpdate& update, std::size_t bytes_received);
  icd::Checked<void> take(const icd::MarkersUpdate& update, std::size_t bytes_received);

  /// Sends nothing more. False while an answer is still awaited.
  bool stop();
  /// The cable is: nothing waits any more for what failed without it.
  void link_is_back();
  /// What has not been taken by the Command Post; empty lists where nothing waits.
  icd::StateUpdate unsent_state() const;
  icd::MarkersUpdate unsent_markers() const;

  /// Whether what is unsent may have changed since this was last asked.
  bool changed_since_asked() { return std::exchange(changed_, false); }

  const Channel& channel() const { return channel_; }
  std::size_t waiting(Kind kind) const;

 private:
  void pump();
  void send_state();
  void send_markers();
  template <class Waiting>
  void answered(Kind kind, UriPace& pace, Waiting sent, std::size_t bytes, const uplink::Outcome& outcome);
  std::vector<Traffic> traffic_of(const lanes::WaitingState& state) const;
  std::vector<Traffic> traffic_of(const lanes::WaitingMarkers& markers) const;
  void put_back(const lanes::WaitingState& state) { state_.put_back(state); }
  void put_back(const lanes::WaitingMarkers& markers) { markers_.put_back(markers); }

  loop::Loop& loop_;
  Record& record_;
  AsForwarded& as_forwarded_;
  Channel channel_;
  UriPace state_pace_, markers_pace_;
  loop::Source wake_;
  lanes::StateLane state_;
  lanes::MarkerLane markers_;
  lanes::StampOrder state_stamps_, marker_stamps_;
  std::uint64_t numbers_ = 0;
  icd::StateUpdate state_under_way_;
  icd::MarkersUpdate markers_under_way_;
  int state_failed_ = 0, markers_failed_ = 0;  // answers in a row of a handler that failed
  bool changed_ = true;
  bool stopping_ = false;
};

}  // namespace adit::gateway
