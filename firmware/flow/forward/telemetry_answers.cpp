// Answers to states and markers.
#include <algorithm>
#include <span>
#include <utility>

#include "dispatch/mapping_verdict.hpp"
#include "forward/telemetry.hpp"

namespace adit::forward {

using dispatch::MappingVerdict;

namespace {

/// Joint failures before the search for the one at fault.
constexpr int kTriesTogether = 3;
/// Markers per turn.
constexpr std::size_t kShown = 500;
/// Beyond this all trials restart.
constexpr std::size_t kMostTrials = 1000;

/// For verdicts other than Taken.
DeliveryFailure why_not(MappingVerdict verdict) {
  if (verdict == MappingVerdict::Throttled) return DeliveryFailure::Throttled;
  return verdict == MappingVerdict::Refused ? DeliveryFailure::Refused : DeliveryFailure::Failed;
}

}  // namespace

template <class Waiting>
void Telemetry::answered(Kind kind, UriPace& pace, const Shared<Waiting>& sent, std::size_t bytes,
                         const uplink::Outcome& outcome) {
  if (kind == Kind::Markers) markers_under_way_.reset();
  under_way_.reset();
  classify(kind, pace, sent, bytes, outcome);
  pump();
}

template <class Waiting>
void Telemetry::classify(Kind kind, UriPace& pace, const Shared<Waiting>& sent, std::size_t bytes,
                         const uplink::Outcome& outcome) {
  const loop::Instant now = loop_.now();
  const auto* answer = std::get_if<uplink::Answered>(&outcome);
  const int status = answer != nullptr ? answer->status : 0;
  auto verdict = answer != nullptr ? dispatch::mapping_verdict(status, dispatch::body_of(answer->body))
                                   : MappingVerdict::Failing;
  const std::string sentence = verdict == MappingVerdict::Taken ? "" : sentence_of(outcome);
  for (const Traffic& traffic : traffic_of(*sent)) {
    if (verdict == MappingVerdict::Taken) {
      record_.forwarded(traffic, 1, bytes, status, loop_.wall_now());
    } else {
      record_.not_taken(traffic, why_not(verdict), status, sentence);
    }
  }
  int& failed = kind == Kind::State ? state_failed_ : markers_failed_;
  failed = verdict == MappingVerdict::Suspect ? failed + 1 : 0;
  switch (verdict) {
    case MappingVerdict::Taken:
      pace.taken(answer->sent, now);
      passed(*sent);
      replace(sent);
      show(sent);
      break;
    case MappingVerdict::Refused:
      pace.taken(answer->sent, now);
      give_up(*sent, status, sentence, bytes);
      break;
    case MappingVerdict::Suspect:
      pace.lost(now);
      if (is_to_blame(*sent)) give_up(*sent, status, sentence, bytes);
      break;
    case MappingVerdict::Throttled:
      pace.throttled(now, answer->retry_after);
      put_back(*sent);
      break;
    case MappingVerdict::Failing:
      pace.failed(outcome, now);
      put_back(*sent);
      break;
  }
}

void Telemetry::passed(const queues::QueuedState& state) {
  state_.passed(state);
  for (const icd::NamedPose& pose : state.update.poses) state_blame_.passed(pose.name.text(), loop_.now());
}

void Telemetry::passed(const queues::QueuedMarkers& markers) {
  marker_blame_.passed("", loop_.now());
  if (markers.is_ahead) return;
  markers_.passed();
  if (marker_trials_.empty()) return;
  for (const icd::Marker& marker : markers.update.markers) marker_trials_.erase({marker.ns, marker.id});
}

void Telemetry::show(const Shared<queues::QueuedState>& state) {
  delivered_.forwarded(state->news, loop_.wall_now());
}

void Telemetry::show(const Shared<queues::QueuedMarkers>& markers) {
  to_show_ = markers;
  shown_ = 0;
}

bool Telemetry::show_some() {
  const std::span<const icd::Marker> all = to_show_->update.markers;
  const auto some = all.subspan(shown_, std::min(all.size() - shown_, kShown));
  delivered_.forwarded(some, loop_.wall_now());
  shown_ += some.size();
  if (shown_ == all.size()) to_show_.reset();
  return some.size() < all.size();
}

template <class Waiting>
void Telemetry::replace(const Shared<Waiting>& sent) {
  const auto written = [this, sent] {
    rejected_writes_ = false;
    done(*sent);
    pump();
  };
  rejected_writes_ = !rejected_.empty() && rejected_.taken(sent->update, written);
  if (!rejected_writes_) done(*sent);
}

void Telemetry::give_up(const queues::QueuedState& state, int status, const std::string& sentence,
                        std::size_t bytes) {
  if (state.update.poses.size() > 1) {
    journal_.state_answered(false);
    return state_.put_back_apart(state);
  }
  for (const icd::NamedPose& pose : state.update.poses) state_.give_up(pose.name, loop_.now());
  set_aside(state.update, status, sentence, bytes, [this, state](bool kept) {
    if (kept) return done(state);
    journal_.state_answered(false);
  });
}

void Telemetry::give_up(const queues::QueuedMarkers& markers, int status, const std::string& sentence,
                        std::size_t bytes) {
  if (markers.is_ahead) return;  // it has its own turn
  if (markers.update.markers.size() > 1) {
    journal_.markers_answered(false);
    return markers_.put_back_narrower(markers);
  }
  for (const icd::Marker& marker : markers.update.markers) marker_trials_.erase({marker.ns, marker.id});
  set_aside(markers.update, status, sentence, bytes, [this, markers](bool kept) {
    if (kept) return done(markers);
    journal_.markers_answered(false);
  });
}

void Telemetry::set_aside(const queues::Message& message, int status, const std::string& sentence,
                          std::size_t bytes, std::function<void(bool kept)> told) {
  const auto go_on = [this, told = std::move(told)](bool kept) {
    rejected_writes_ = false;
    told(kept);
    pump();
  };
  rejected_.add(message, status, sentence, bytes, {.told = go_on});
  rejected_writes_ = true;
}

bool Telemetry::is_to_blame(const queues::QueuedState& state) {
  bool to_blame = state_failed_ >= kTriesTogether;
  if (state.update.poses.size() == 1) {
    const icd::RobotName& name = state.update.poses.front().name;
    to_blame =
        state_blame_.failed(name.text(), state_.trial_of(name), loop_.now()) == queues::Blame::Next::Reject;
  }
  if (!to_blame) put_back(state);
  return to_blame;
}

bool Telemetry::is_to_blame(const queues::QueuedMarkers& markers) {
  if (markers.is_ahead) return false;
  if (markers.update.markers.size() != 1) {
    const bool narrow = markers_failed_ >= kTriesTogether;
    if (!narrow) put_back(markers);
    return narrow;
  }
  const icd::Marker& marker = markers.update.markers.front();
  if (marker_trials_.size() >= kMostTrials) marker_trials_.clear();
  const bool to_blame = marker_blame_.failed("", marker_trials_[{marker.ns, marker.id}], loop_.now()) ==
                        queues::Blame::Next::Reject;
  if (!to_blame) {
    journal_.markers_answered(false);
    markers_.put_behind(markers);
  }
  return to_blame;
}
std::vector<Traffic> Telemetry::traffic_of(const queues::QueuedState& state) const {
  std::vector<Traffic> all;
  all.reserve(state.news.size());
  for (const icd::NamedPose& pose : state.news) all.push_back({Kind::State, pose.name.text()});
  return all;
}

std::vector<Traffic> Telemetry::traffic_of(const queues::QueuedMarkers&) const {
  return {{Kind::Markers, ""}};
}

template void Telemetry::answered(Kind, UriPace&, const Shared<queues::QueuedState>&, std::size_t,
                                  const uplink::Outcome&);
template void Telemetry::answered(Kind, UriPace&, const Shared<queues::QueuedMarkers>&, std::size_t,
                                  const uplink::Outcome&);

}  // namespace adit::forward
