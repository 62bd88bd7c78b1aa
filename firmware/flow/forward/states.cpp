#include "forward/states.hpp"

#include <utility>

#include "codec/write.hpp"
#include "icd/refuse.hpp"

namespace adit::forward {

States::States(loop::Loop& loop, const settings::Settings& settings, TrafficCounts& counts,
               std::mt19937_64& random, journal::Journal& journal, DeliveredScene& delivered)
    : loop_(loop),
      counts_(counts),
      journal_(journal),
      delivered_(delivered),
      pace_(kUri, settings.command_post.rates.state_hz, random, journal) {}

void States::carry_on(const journal::Carried& carried) {
  pace_.carry_on(carried, loop_.now());
  for (const auto& [name, robot] : carried.robots()) {
    queue_.add({&robot.posted, 1}, loop_.now());
    counts_.accepted({Kind::State, name.text()}, 0,
                     time_of(loop_, robot.posted.stamp.value_or(loop_.stamp_now())));
  }
  queue_.begin_run();  // perhaps from before this run: each goes once
}

void States::endpoint_turned() {
  pace_.link_is_back();
  queue_.forget_what_was_taken();
  queue_.join_all();
  failed_ = 0;
  blame_ = {};
}

icd::Checked<void> States::has_room_for(const icd::StateUpdate& update) {
  if (queue_.has_room_for(update)) return {};
  for (const icd::NamedPose& pose : update.poses)
    counts_.no_room({Kind::State, pose.name.text()}, loop_.wall_now());
  return icd::refuse(icd::Status::TooManyRequests, "not accepted: too many robots; send it again later");
}

icd::Checked<void> States::accept(const std::vector<queues::PostedPose>& poses, std::size_t bytes_received) {
  const std::vector<queues::PostedPose> news = queue_.news_in(poses);
  if (const auto kept = journal_.accepted(news); !kept)
    return icd::refuse(icd::Status::ServiceUnavailable, "not accepted: it cannot be stored: ", kept.error(),
                       "; send it again later");
  for (const queues::PostedPose& pose : poses)
    counts_.accepted({Kind::State, pose.name.text()}, bytes_received, loop_.wall_now());
  queue_.add(news, loop_.now());
  return {};
}

bool States::send_again(const icd::StateUpdate& state) {
  queue_.add_unless_known(state, loop_.now());  // a newer pose wins
  return journal_.accepted(queue_.unsent()).has_value();
}

std::optional<loop::Instant> States::accepted_at(const std::string& robot) const {
  const auto name = icd::RobotName::parse(robot);
  return name ? queue_.accepted_at(*name) : std::nullopt;
}

States::Sent States::take() {
  auto waiting = queue_.take(loop_.now());
  if (!waiting) return nullptr;
  icd::Header& header = waiting->update.header;
  header.stamp = pace_.next_stamp(header.stamp.value_or(loop_.stamp_now()));
  pace_.keep_stamp(*header.stamp);
  journal_.state_sent(waiting->update);
  return std::make_shared<const queues::QueuedState>(std::move(*waiting));
}

icd::ChunkedBytes States::body_of(const queues::QueuedState& state) {
  return codec::write_state_update(state.update);
}

std::vector<Traffic> States::traffic_of(const queues::QueuedState& state) {
  std::vector<Traffic> all;
  all.reserve(state.news.size());
  for (const icd::NamedPose& pose : state.news) all.push_back({Kind::State, pose.name.text()});
  return all;
}

void States::passed(const queues::QueuedState& state) {
  failed_ = 0;
  queue_.passed(state);
  for (const icd::NamedPose& pose : state.update.poses) blame_.passed(pose.name.text(), loop_.now());
}

void States::show(const Sent& state) {
  delivered_.forwarded(state->news, loop_.wall_now());
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
    to_blame = ++failed_ >= kTriesTogether;
    if (to_blame) pace_.forget_failures();
  } else if (queues::Trial* const trial = queue_.trial_of(state)) {
    to_blame = blame_.failed(state.update.poses.front().name.text(), *trial, loop_.now(), may_reject) ==
               queues::Blame::Next::Reject;
  }
  if (!to_blame) put_back(state);
  return to_blame;
}

bool States::give_up(const queues::QueuedState& state) {
  const bool are_several = state.update.poses.size() > 1;
  if (!are_several) queue_.give_up(state.update.poses.front().name, loop_.now());
  if (!are_several && !state.news.empty()) return true;
  finish(state, false);
  if (are_several) queue_.put_back_apart(state);
  return false;
}

}  // namespace adit::forward
