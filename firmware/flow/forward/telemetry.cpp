#include "forward/telemetry.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "codec/write.hpp"
#include "dispatch/turn.hpp"
#include "icd/refuse.hpp"

namespace adit::forward {

namespace {

/// Markers to write in one turn.
constexpr std::size_t kAtOnce = 500;

queues::MarkerBounds bounds_of(const settings::Queues& queues) {
  return {.per_message = queues.markers_per_message,
          .bytes_per_message = queues.marker_bytes_per_message,
          .bytes = queues.marker_bytes};
}

}  // namespace

Telemetry::Telemetry(loop::Loop& loop, loop::Workers& workers, const settings::Settings& settings,
                     std::optional<icd::BearerToken> token, Record& record, RejectedStore& rejected,
                     std::mt19937_64& random, journal::Journal& journal, DeliveredScene& delivered)
    : loop_(loop),
      settings_(settings),
      record_(record),
      rejected_(rejected),
      journal_(journal),
      delivered_(delivered),
      channel_(loop, "mapping", access_to_mapping(settings.command_post, std::move(token))),
      state_pace_(icd::Uri::StateUpdate, settings.command_post.rates.state_hz, random, journal),
      markers_pace_(icd::Uri::MarkersUpdate, settings.command_post.rates.markers_hz, random, journal),
      wake_(loop.timer([this] { pump(); })),
      markers_(bounds_of(settings.queues)),
      arrivals_(loop, workers, journal, markers_, record, [this] { pump(); }) {}

void Telemetry::carry_on(const journal::Carried& carried) {
  state_pace_.carry_on(carried, loop_.now());
  markers_pace_.carry_on(carried, loop_.now());
  for (const auto& [uri, stamp] : carried.stamps()) {
    if (uri == icd::Uri::StateUpdate) state_stamps_.carry_on(stamp);
    if (uri == icd::Uri::MarkersUpdate) marker_stamps_.carry_on(stamp);
  }
  for (const auto& [name, robot] : carried.robots()) {
    state_.add({&robot.posted, 1}, loop_.now());
    record_.accepted({Kind::State, name.text()}, 0,
                     time_of(loop_, robot.posted.stamp.value_or(loop_.stamp_now())));
  }
  state_.begin_run();  // perhaps from before this run: each goes once
  if (icd::MarkersUpdate markers = carried.markers(); !markers.markers.empty()) {
    record_.accepted({Kind::Markers, ""}, 0, loop_.wall_now());
    markers_.add(std::move(markers), loop_.now());
  }
}

void Telemetry::settings_changed() {
  markers_.keep_within(bounds_of(settings_.queues));
  state_pace_.allow(settings_.command_post.rates.state_hz, loop_.now());
  markers_pace_.allow(settings_.command_post.rates.markers_hz, loop_.now());
  pump();
}

void Telemetry::endpoint_changed(std::optional<icd::BearerToken> token) {
  channel_.lead_to(access_to_mapping(settings_.command_post, std::move(token)));
  channel_.give_up();
  pump();
}

/// Another Command Post knows no robots yet.
void Telemetry::endpoint_turned() {
  state_pace_.link_is_back();
  markers_pace_.link_is_back();
  state_.forget_what_was_taken();
  state_failed_ = markers_failed_ = 0;
  state_blame_ = marker_blame_ = {};
  marker_trials_.clear();
}

icd::Checked<void> Telemetry::has_room_for(const icd::StateUpdate& update) {
  if (state_.has_room_for(update)) return {};
  for (const icd::NamedPose& pose : update.poses)
    record_.no_room({Kind::State, pose.name.text()}, loop_.wall_now());
  return icd::refuse(icd::Status::TooManyRequests, "not accepted: too many robots; send it again later");
}

icd::Checked<void> Telemetry::take(const std::vector<queues::PostedPose>& poses,
                                   std::size_t bytes_received) noexcept {
  const std::vector<queues::PostedPose> news = state_.news_in(poses);
  if (const auto kept = journal_.accepted(news); !kept)
    return icd::refuse(icd::Status::ServiceUnavailable, "not accepted: it cannot be stored: ", kept.error(),
                       "; send it again later");
  for (const queues::PostedPose& pose : poses)
    record_.accepted({Kind::State, pose.name.text()}, bytes_received, loop_.wall_now());
  state_.add(news, loop_.now());
  pump();
  return {};
}

void Telemetry::pump() noexcept {
  if (to_show_ && show_some()) return wake_.call_at(loop_.now());
  if (!stopping_ && !rejected_writes_ && channel_.turns()) endpoint_turned();
  if (stopping_ || rejected_writes_ || channel_.busy() || !channel_.has_token()) return;
  send_next();
}

void Telemetry::send_next() {
  if (markers_under_way_) return write_markers();
  const std::array candidates = {
      dispatch::Candidate{state_.oldest(), state_pace_.ready()},
      dispatch::Candidate{arrivals_.is_in_part() ? std::nullopt : markers_.oldest(), markers_pace_.ready()}};
  const dispatch::Turn turn = dispatch::oldest_first(candidates, loop_.now());
  if (turn.wake) wake_.call_at(*turn.wake);
  if (turn.candidate == 0) send_state();
  if (turn.candidate == 1) send_markers();
}

void Telemetry::send_state() {
  auto waiting = state_.take(loop_.now());
  if (!waiting) return;
  waiting->update.header.stamp = state_stamps_.next(waiting->update.header.stamp.value_or(loop_.stamp_now()));
  journal_.stamped(icd::Uri::StateUpdate, *waiting->update.header.stamp);
  journal_.state_sent(waiting->update);
  const icd::ChunkedBytes body = codec::write_state_update(waiting->update);
  state_pace_.sent(loop_.now());
  under_way_ = {Kind::State, waiting->accepted};
  channel_.send(
      icd::Uri::StateUpdate, codec::kCbor, body,
      [this, sent = std::make_shared<const queues::QueuedState>(std::move(*waiting)), bytes = body.size()](
          const uplink::Outcome& outcome) { answered(Kind::State, state_pace_, sent, bytes, outcome); });
}

void Telemetry::send_markers() {
  auto waiting = markers_.take();
  if (!waiting) return;
  for (icd::Marker& marker : waiting->update.markers) {
    marker.header.stamp = marker_stamps_.next(marker.header.stamp.value_or(loop_.stamp_now()));
  }
  if (!waiting->update.markers.empty()) {
    journal_.stamped(icd::Uri::MarkersUpdate, *waiting->update.markers.back().header.stamp);
  }
  if (!waiting->is_ahead) journal_.markers_sent(waiting->update);
  under_way_ = {Kind::Markers, waiting->accepted};
  markers_under_way_ = std::make_shared<const queues::QueuedMarkers>(std::move(*waiting));
  if (markers_under_way_->update.markers.size() > kAtOnce) return wake_.call_at(loop_.now());
  write_markers();
}

void Telemetry::write_markers() {
  const Shared<queues::QueuedMarkers> sent = markers_under_way_;
  const icd::ChunkedBytes body = codec::write_markers_update(sent->update);
  markers_pace_.sent(loop_.now());
  channel_.send(icd::Uri::MarkersUpdate, codec::kCbor, body,
                [this, sent, bytes = body.size()](const uplink::Outcome& outcome) {
                  answered(Kind::Markers, markers_pace_, sent, bytes, outcome);
                });
}

bool Telemetry::send_again(const queues::Message& message) {
  const bool kept = std::visit([this](const auto& each) { return wait_again(each); }, message);
  pump();
  return kept;
}

bool Telemetry::wait_again(const icd::StateUpdate& state) {
  state_.add_unless_known(state, loop_.now());  // a newer pose wins
  return journal_.accepted(state_.unsent()).has_value();
}

/// In the journal the last one wins, so a deletion of all must precede queued markers.
bool Telemetry::wait_again(icd::MarkersUpdate markers) {
  const auto deletes_all = [](const icd::Marker& marker) {
    return marker.action == icd::MarkerAction::DeleteAll;
  };
  const bool wipes = std::ranges::any_of(markers.markers, deletes_all);
  queues::MarkerChanges under_way;
  if (markers_under_way_) {
    for (const icd::Marker& marker : markers_under_way_->update.markers) under_way.apply(marker);
  }
  if (arrivals_.is_in_part() || (wipes && !under_way.empty())) return false;
  std::erase_if(markers.markers, [&](const icd::Marker& marker) {
    return markers_.says_more_than(marker) || under_way.says_more_than(marker);
  });
  if (markers.markers.empty()) return true;
  icd::MarkersUpdate in_order = markers;
  if (wipes) std::ranges::copy(markers_.pending(), std::back_inserter(in_order.markers));
  if (!journal_.accepted(in_order)) return false;
  markers_.put_back({.update = std::move(markers), .accepted = loop_.now(), .updates = 1});
  return true;
}

void Telemetry::link_is_back() {
  state_pace_.link_is_back();
  markers_pace_.link_is_back();
  channel_.hurry();
  pump();
}

bool Telemetry::stop() {
  stopping_ = true;
  return !channel_.busy() && arrivals_.empty() && !to_show_;
}

std::size_t Telemetry::waiting(Kind kind) const {
  if (kind == Kind::State) return state_.empty() ? 0 : 1;
  return markers_.count();
}

std::optional<loop::Instant> Telemetry::waits_since(const Traffic& traffic) const {
  const bool state = traffic.kind == Kind::State;
  if (state) {
    const auto name = icd::RobotName::parse(traffic.robot);
    if (!name || !state_.waits(*name)) return std::nullopt;
  }
  auto oldest = state ? state_.oldest() : markers_.oldest();
  if (under_way_ && under_way_->first == traffic.kind)
    oldest = std::min(oldest.value_or(under_way_->second), under_way_->second);
  return oldest;
}

}  // namespace adit::forward
