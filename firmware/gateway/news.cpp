#include "gateway/news.hpp"

#include <array>

#include "codec/write.hpp"
#include "dispatch/turn.hpp"
#include "gateway/upstream_answer.hpp"
#include "host/log.hpp"

namespace adit::gateway {

using dispatch::MappingVerdict;

namespace {

std::unexpected<icd::Refusal> full(const char* of) {
  return std::unexpected(
      icd::Refusal{icd::Status::TooManyRequests, std::string("not taken: ") + of + "; send it again later"});
}

/// For a verdict that is not Taken.
NotTaken why_not(MappingVerdict verdict) {
  if (verdict == MappingVerdict::Throttled) return NotTaken::Throttled;
  return verdict == MappingVerdict::Refused ? NotTaken::Refused : NotTaken::Failed;
}

std::size_t updates_in(const lanes::WaitingState& state) {
  return state.updates;
}
std::size_t updates_in(const lanes::WaitingMarkers& markers) {
  return markers.updates.size();
}

}  // namespace

News::News(loop::Loop& loop, const settings::Settings& settings, std::optional<icd::BearerToken> token,
           Record& record, std::mt19937_64& random, AsForwarded& as_forwarded)
    : loop_(loop),
      record_(record),
      as_forwarded_(as_forwarded),
      channel_(loop, "mapping", endpoint_of(settings.command_post, settings.command_post.mapping, 0),
               std::move(token), settings.command_post.timeouts.mapping_answer),
      state_pace_(settings.command_post.rates.state_hz, random),
      markers_pace_(settings.command_post.rates.markers_hz, random),
      wake_(loop.timer([this] { pump(); })),
      markers_(settings.queues.markers_per_message) {}

icd::Checked<void> News::take(const icd::StateUpdate& update, std::size_t bytes_received) {
  if (!state_.has_room_for(update)) return full("more robots than can be kept apart");
  for (const icd::NamedPose& pose : update.poses) {
    record_.accepted({Kind::State, pose.name.text()}, bytes_received, loop_.stamp_now());
  }
  state_.add(update, loop_.now());
  changed_ = true;
  pump();
  return {};
}

icd::Checked<void> News::take(const icd::MarkersUpdate& update, std::size_t bytes_received) {
  if (!markers_.has_room_for(update)) return full("more markers than can wait");
  record_.accepted({Kind::Markers, ""}, bytes_received, loop_.stamp_now());
  markers_.add(++numbers_, update, loop_.now());
  changed_ = true;
  pump();
  return {};
}

void News::pump() {
  if (stopping_ || channel_.busy() || !channel_.has_token()) return;
  const std::array candidates = {dispatch::Candidate{state_.oldest(), state_pace_.ready()},
                                 dispatch::Candidate{markers_.oldest(), markers_pace_.ready()}};
  const dispatch::Turn turn = dispatch::oldest_first(candidates, loop_.now());
  if (turn.wake) wake_.call_at(*turn.wake);
  if (turn.candidate == 0) send_state();
  if (turn.candidate == 1) send_markers();
}

void News::send_state() {
  auto waiting = state_.take();
  if (!waiting) return;
  waiting->update.header.stamp = state_stamps_.next(waiting->update.header.stamp.value_or(loop_.stamp_now()));
  state_under_way_ = waiting->update;
  const icd::ChunkedBytes body = codec::write_state_update(waiting->update);
  state_pace_.sent(loop_.now());
  channel_.send(icd::Uri::StateUpdate, codec::kCbor, body,
                [this, sent = std::move(*waiting), bytes = body.size()](const uplink::Outcome& outcome) {
                  state_under_way_.poses.clear();
                  answered(Kind::State, state_pace_, sent, bytes, outcome);
                });
}

void News::send_markers() {
  auto waiting = markers_.take();
  if (!waiting) return;
  for (icd::Marker& marker : waiting->update.markers) {
    marker.header.stamp = marker_stamps_.next(marker.header.stamp.value_or(loop_.stamp_now()));
  }
  markers_under_way_ = waiting->update;
  const icd::ChunkedBytes body = codec::write_markers_update(waiting->update);
  markers_pace_.sent(loop_.now());
  channel_.send(icd::Uri::MarkersUpdate, codec::kCbor, body,
                [this, sent = std::move(*waiting), bytes = body.size()](const uplink::Outcome& outcome) {
                  markers_under_way_.markers.clear();
                  answered(Kind::Markers, markers_pace_, sent, bytes, outcome);
                });
}

template <class Waiting>
void News::answered(Kind kind, UriPace& pace, Waiting sent, std::size_t bytes,
                    const uplink::Outcome& outcome) {
  changed_ = true;
  const loop::Instant now = loop_.now();
  const auto* answer = std::get_if<uplink::Answered>(&outcome);
  const int status = answer != nullptr ? answer->status : 0;
  auto verdict = answer != nullptr ? dispatch::mapping_verdict(status) : MappingVerdict::Failing;
  int& failed = kind == Kind::State ? state_failed_ : markers_failed_;
  failed = status == dispatch::kHandlerFailed ? failed + 1 : 0;
  if (failed >= dispatch::kMostTries) {
    verdict = MappingVerdict::Refused;
    failed = 0;
  }
  const std::string sentence = verdict == MappingVerdict::Taken ? "" : sentence_of(outcome);
  for (const Traffic& traffic : traffic_of(sent)) {
    if (verdict == MappingVerdict::Taken) {
      record_.forwarded(traffic, updates_in(sent), bytes, status, loop_.stamp_now());
    } else {
      record_.not_taken(traffic, why_not(verdict), status, sentence);
    }
  }
  switch (verdict) {
    case MappingVerdict::Taken:
      pace.taken(now);
      as_forwarded_.forwarded(sent.update, loop_.stamp_now());
      break;
    case MappingVerdict::Refused:
      pace.taken(now);
      host::log(host::Level::Warning,
                kind == Kind::State ? "the Command Post refused a state" : "the Command Post refused markers",
                {{"status", std::to_string(status)}, {"why", sentence}});
      break;
    case MappingVerdict::Throttled:
      pace.throttled(now, answer->retry_after);
      put_back(sent);
      break;
    case MappingVerdict::Failing:
      pace.failed(now);
      put_back(sent);
      break;
  }
  pump();
}

std::vector<Traffic> News::traffic_of(const lanes::WaitingState& state) const {
  std::vector<Traffic> all;
  all.reserve(state.update.poses.size());
  for (const icd::NamedPose& pose : state.update.poses) all.push_back({Kind::State, pose.name.text()});
  return all;
}

std::vector<Traffic> News::traffic_of(const lanes::WaitingMarkers&) const {
  return {{Kind::Markers, ""}};
}

void News::link_is_back() {
  state_pace_.link_is_back();
  markers_pace_.link_is_back();
  channel_.hurry();
  pump();
}

bool News::stop() {
  stopping_ = true;
  return !channel_.busy();
}

icd::StateUpdate News::unsent_state() const {
  lanes::StateLane lane = state_;
  if (auto waiting = lane.take()) return waiting->update;
  return state_under_way_;
}

icd::MarkersUpdate News::unsent_markers() const {
  return {.markers = lanes::merge(markers_under_way_.markers, markers_.pending())};
}

std::size_t News::waiting(Kind kind) const {
  if (kind == Kind::State) return state_.empty() ? 0 : 1;
  return markers_.count();
}

}  // namespace adit::gateway
