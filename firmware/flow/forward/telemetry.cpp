#include "forward/telemetry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "codec/write.hpp"
#include "dispatch/verdicts.hpp"
#include "icd/sentence.hpp"

namespace adit::forward {

States::States(loop::Loop& loop, const settings::Settings& settings, TrafficCounts& counts,
               std::mt19937_64& random, journal::Journal& journal, DeliveredScene& delivered)
    : loop_(loop),
      counts_(counts),
      journal_(journal),
      delivered_(delivered),
      pace_(kUri, settings.command_post.rates.state_hz, random, journal) {}

void States::restore(const journal::HandoverState& carried) {
  pace_.restore(carried, loop_.now());
  for (const auto& [name, robot] : carried.robots()) {
    const double behind = carried.lag(name.text(), static_cast<std::size_t>(TrafficKind::State));
    queue_.add({&robot.posted, 1}, std::isnan(behind) ? loop_.now() : instant_of(loop_, behind));
    counts_.count_accepted({TrafficKind::State, name.text()}, 0,
                           time_of(loop_, robot.posted.stamp.value_or(loop_.stamp_now())));
  }
  queue_.begin_run();  // perhaps from before this run: each goes once
}

void States::on_new_command_post() {
  pace_.on_link_up();
  queue_.forget_accepted();
  queue_.join_all();
  failed_ = 0;
  blame_ = {};
}

icd::Checked<void> States::has_room_for(const icd::StateUpdate& update) {
  if (queue_.has_room_for(update)) return {};
  for (const icd::NamedPose& pose : update.poses)
    counts_.no_room({TrafficKind::State, pose.name.text()}, loop_.wall_now());
  return icd::refuse(icd::Status::TooManyRequests, "not accepted: too many robots; send it again later");
}

icd::Checked<void> States::accept(const std::vector<queues::PostedPose>& poses, std::size_t bytes_received) {
  const std::vector<queues::PostedPose> news = queue_.news_in(poses);
  if (const auto kept = journal_.record_accepted(news); !kept)
    return icd::refuse(icd::Status::ServiceUnavailable, "not accepted: it cannot be stored: ", kept.error(),
                       "; send it again later");
  for (const queues::PostedPose& pose : poses)
    counts_.count_accepted({TrafficKind::State, pose.name.text()}, bytes_received, loop_.wall_now());
  queue_.add(news, loop_.now());
  return {};
}

bool States::resend(const icd::StateUpdate& state) {
  queue_.add_unless_known(state, loop_.now());  // a newer pose wins
  return journal_.record_accepted(queue_.unsent()).has_value();
}

std::optional<loop::Instant> States::accepted_at(const std::string& robot) const {
  const auto name = icd::RobotName::parse(robot);
  return name ? queue_.accepted_at(*name) : std::nullopt;
}

States::Sent States::pop() {
  auto waiting = queue_.pop(loop_.now());
  if (!waiting) return nullptr;
  icd::Header& header = waiting->update.header;
  header.stamp = pace_.next_stamp(header.stamp.value_or(loop_.stamp_now()));
  pace_.keep_stamp(*header.stamp);
  journal_.record_state_sent(waiting->update);
  return std::make_shared<const queues::QueuedState>(std::move(*waiting));
}

icd::ChunkedBytes States::body_of(const queues::QueuedState& state) {
  return codec::write_state_update(state.update);
}

std::vector<Traffic> States::traffic_of(const queues::QueuedState& state) {
  std::vector<Traffic> all;
  all.reserve(state.news.size());
  for (const icd::NamedPose& pose : state.news) all.push_back({TrafficKind::State, pose.name.text()});
  return all;
}

void States::on_passed(const queues::QueuedState& state) {
  failed_ = 0;
  queue_.on_passed(state);
  for (const icd::NamedPose& pose : state.update.poses) blame_.on_passed(pose.name.text(), loop_.now());
}

void States::put_back(const queues::QueuedState& state) {
  finish(state, false);
  queue_.put_back(state);
}

bool States::is_on_trial(const queues::QueuedState& state) {
  const queues::Trial* const trial = queue_.trial_of(state);
  return trial != nullptr && trial->strikes > 0;
}

bool States::is_to_blame(const queues::QueuedState& state, bool may_reject) {
  bool to_blame = false;
  if (state.update.poses.size() > 1) {
    to_blame = ++failed_ >= Markers::kTriesTogether;
    if (to_blame) pace_.forget_failures();
  } else if (queues::Trial* const trial = queue_.trial_of(state)) {
    to_blame = blame_.on_failed(state.update.poses.front().name.text(), *trial, loop_.now(), may_reject) ==
               queues::Blame::Decision::Reject;
  }
  if (!to_blame) put_back(state);
  return to_blame;
}

bool States::give_up(const queues::QueuedState& state) {
  const bool are_several = state.update.poses.size() > 1;
  if (!are_several) queue_.give_up(state.update.poses.front().name, loop_.now());
  if (!are_several && !state.news.empty()) return true;
  finish(state, false);
  if (are_several) queue_.put_back_single(state);
  return false;
}

namespace {

using dispatch::MappingVerdict;

/// For verdicts other than Taken.
DeliveryFailure failure_of(MappingVerdict verdict) {
  if (verdict == MappingVerdict::Throttled) return DeliveryFailure::Throttled;
  return verdict == MappingVerdict::Refused ? DeliveryFailure::Refused : DeliveryFailure::Failed;
}

}  // namespace

Telemetry::Telemetry(loop::Loop& loop, uplink::Servers& servers, loop::Workers& workers,
                     const settings::Settings& settings, std::optional<icd::BearerToken> token,
                     TrafficCounts& counts, RejectedStore& rejected, std::mt19937_64& random,
                     journal::Journal& journal, DeliveredScene& delivered)
    : loop_(loop),
      settings_(settings),
      counts_(counts),
      rejected_(rejected),
      channel_(loop, servers, "mapping", access_to_mapping(settings.command_post, std::move(token)),
               [this] { pump(); }),
      wake_(loop.timer([this] { pump(); })),
      states_(loop, settings, counts, random, journal, delivered),
      markers_(loop, workers, settings, counts, random, journal, delivered) {}

void Telemetry::restore(const journal::HandoverState& carried) {
  states_.restore(carried);
  markers_.restore(carried);
}

void Telemetry::on_settings_changed() {
  states_.pace().allow(settings_.command_post.rates.state_hz, loop_.now());
  markers_.on_settings_changed(settings_);
  pump();
}

void Telemetry::on_endpoint_changed(std::optional<icd::BearerToken> token) {
  channel_.lead_to(access_to_mapping(settings_.command_post, std::move(token)));
  channel_.give_up();
  pump();
}

icd::Checked<void> Telemetry::accept(const std::vector<queues::PostedPose>& poses,
                                     std::size_t bytes_received) noexcept {
  auto accepted = states_.accept(poses, bytes_received);
  if (accepted) pump();
  return accepted;
}

void Telemetry::pump() noexcept {
  if (markers_.show_some()) return wake_.call_at(loop_.now());
  if (!stopping_ && !rejected_writes_ && channel_.turns()) {
    states_.on_new_command_post();
    markers_.on_new_command_post();
  }
  if (stopping_ || rejected_writes_ || channel_.busy() || !channel_.has_token()) return;
  send_next();
}

void Telemetry::send_next() {
  if (markers_.sent_message()) {
    if (channel_.claim_turn()) send(markers_, markers_.sent_message());
    return;
  }
  const auto state = states_.next();
  const std::array candidates = {
      state ? pace::Candidate{state->accepted, std::max(state->ready, states_.pace().ready())}
            : pace::Candidate{},
      pace::Candidate{markers_.oldest_to_send(), markers_.pace().ready()}};
  const pace::Turn turn = pace::oldest_first(candidates, loop_.now());
  if (turn.wake) wake_.call_at(*turn.wake);
  if (!turn.candidate || !channel_.claim_turn()) return;
  if (turn.candidate == 1) return send_markers();
  if (const States::Sent next = states_.pop()) send(states_, next);
}

/// Many markers are written in a turn of their own.
void Telemetry::send_markers() {
  const Markers::Sent next = markers_.pop();
  if (!next) return;
  if (next->update.markers.size() > Markers::kAtOnce) return wake_.call_at(loop_.now());
  send(markers_, next);
}

template <class Of>
void Telemetry::send(Of& of, const typename Of::Sent& sent) {
  const icd::ChunkedBytes body = Of::body_of(*sent);
  of.pace().on_sent(loop_.now());
  channel_.send(
      Of::kUri, codec::kCbor, body,
      [this, &of, sent, bytes = body.size()](const uplink::Outcome& outcome) {
        on_answered(of, sent, bytes, outcome);
      },
      {}, of.is_on_trial(*sent));
}

template <class Of>
void Telemetry::on_answered(Of& of, const typename Of::Sent& sent, std::size_t bytes,
                            const uplink::Outcome& outcome) {
  markers_.on_answered();
  classify(of, sent, bytes, outcome);
  pump();
}

template <class Of>
void Telemetry::classify(Of& of, const typename Of::Sent& sent, std::size_t bytes,
                         const uplink::Outcome& outcome) {
  const loop::Instant now = loop_.now();
  const auto* answer = std::get_if<uplink::Answered>(&outcome);
  const int status = answer != nullptr ? answer->status : 0;
  const auto verdict = answer != nullptr ? dispatch::mapping_verdict(status, dispatch::body_of(answer->body))
                                         : MappingVerdict::Failing;
  const bool concerns_a_part = dispatch::can_concern_part(status) && verdict != MappingVerdict::Refused;
  const bool is_to_blame = concerns_a_part && of.is_to_blame(*sent, verdict == MappingVerdict::Suspect ||
                                                                        verdict == MappingVerdict::TooLarge);
  std::string sentence = verdict == MappingVerdict::Taken ? "" : sentence_of(outcome, bytes);
  if (concerns_a_part && !is_to_blame && of.is_on_trial(*sent))
    sentence += icd::sentence("; other ", Of::kMessages, " are accepted; Adit tries this one again within ",
                              queues::Blame::kLongestRest.count(), " s");
  for (const Traffic& traffic : Of::traffic_of(*sent)) {
    if (verdict == MappingVerdict::Taken) {
      counts_.count_forwarded(traffic, 1, bytes, status, loop_.wall_now());
    } else {
      counts_.count_undelivered(traffic, failure_of(verdict), status, sentence);
    }
  }
  switch (verdict) {
    case MappingVerdict::Taken:
      of.pace().on_answered(answer->sent, now);
      of.on_passed(*sent);
      replace(of, sent);
      of.show(sent);
      break;
    case MappingVerdict::Refused:
      of.pace().on_answered(answer->sent, now);
      give_up(of, sent, status, sentence, bytes);
      break;
    case MappingVerdict::Throttled:
      of.pace().on_throttled(now, answer->retry_after);
      of.put_back(*sent);
      break;
    case MappingVerdict::TooLarge:
    case MappingVerdict::Suspect:
    case MappingVerdict::Failing:
      of.pace().on_failed(outcome, now);
      if (is_to_blame) give_up(of, sent, status, sentence, bytes);
      if (!concerns_a_part) of.put_back(*sent);
      break;
  }
}

template <class Of>
void Telemetry::replace(Of& of, const typename Of::Sent& sent) {
  const auto written = [this, &of, sent] {
    rejected_writes_ = false;
    of.finish(*sent, true);
    pump();
  };
  rejected_writes_ = !rejected_.empty() && rejected_.mark_contained(sent->update, written);
  if (!rejected_writes_) of.finish(*sent, true);
}

template <class Of>
void Telemetry::give_up(Of& of, const typename Of::Sent& sent, int status, const std::string& sentence,
                        std::size_t bytes) {
  if (!of.give_up(*sent)) return;
  const auto told = [this, &of, sent](bool kept) {
    rejected_writes_ = false;
    of.finish(*sent, kept);
    pump();
  };
  rejected_.add(sent->update, status, sentence, bytes, {.on_stored = told});
  rejected_writes_ = true;
}

bool Telemetry::resend(const queues::Message& message) {
  bool kept = false;
  if (const auto* state = std::get_if<icd::StateUpdate>(&message)) kept = states_.resend(*state);
  if (const auto* markers = std::get_if<icd::MarkersUpdate>(&message)) kept = markers_.resend(*markers);
  pump();
  return kept;
}

void Telemetry::on_link_up() {
  states_.pace().on_link_up();
  markers_.pace().on_link_up();
  channel_.retry_now();
  pump();
}

bool Telemetry::stop() {
  stopping_ = true;
  return !channel_.busy() && markers_.is_idle();
}

std::size_t Telemetry::waiting(TrafficKind kind) const {
  if (kind == TrafficKind::State) return states_.empty() ? 0 : 1;
  return markers_.count();
}

std::optional<loop::Instant> Telemetry::oldest_acceptance(const Traffic& traffic) const {
  if (traffic.kind == TrafficKind::State) return states_.accepted_at(traffic.robot);
  const auto oldest = markers_.oldest();
  if (!markers_.sent_message()) return oldest;
  return std::min(oldest.value_or(markers_.sent_message()->accepted), markers_.sent_message()->accepted);
}

}  // namespace adit::forward
