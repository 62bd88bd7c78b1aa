#include "gateway/observed_facts.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace adit::gateway {

void Crowding::on_ended(intake::CloseReason why, const std::string& address, loop::Instant now) {
  Kind& kind = kinds_[static_cast<std::size_t>(why)];
  if (now - kind.last >= kRecent) kind.by_address.clear();
  kind.last = now;
  ++kind.count;
  if (kind.by_address.size() < kMostAddresses || kind.by_address.contains(address))
    ++kind.by_address[address];
}

std::vector<facts::Crowd> Crowding::crowds(loop::Instant now) const {
  using enum facts::Crowd::Kind;
  std::vector<facts::Crowd> crowds;
  for (const intake::CloseReason why : kTold) {
    if (at(why).count == 0 || now - at(why).last >= kRecent) continue;
    const auto kind = why == intake::CloseReason::NoRoom       ? NoRoom
                      : why == intake::CloseReason::WrongToken ? WrongToken
                      : why == intake::CloseReason::NoToken    ? NoToken
                                                               : Unauthenticated;
    crowds.push_back({kind, most_of(why)});
  }
  return crowds;
}

std::vector<Crowding::Line> Crowding::to_log(loop::Instant now) {
  std::vector<Line> lines;
  for (const intake::CloseReason why : kTold) {
    Kind& kind = kinds_[static_cast<std::size_t>(why)];
    if (kind.count == kind.logged || now < kind.log_at) continue;
    lines.push_back({sentence(why), kind.count - kind.logged});
    kind.logged = kind.count;
    kind.log_at = now + kLogEvery;
  }
  return lines;
}

const std::string& Crowding::most_of(intake::CloseReason why) const {
  return std::ranges::max_element(at(why).by_address, {}, [](const auto& each) { return each.second; })
      ->first;
}

std::string Crowding::sentence(intake::CloseReason why) const {
  const std::string& most = most_of(why);
  if (why == intake::CloseReason::NoRoom) {
    return "requests rejected with 503, most from " + most +
           ": too many requests at once (team.connections, team.connections_per_address)";
  }
  if (why == intake::CloseReason::WrongToken) {
    return "requests with wrong tokens, most from " + most +
           ": robots with an old token, or an attacker; right tokens are accepted";
  }
  if (why == intake::CloseReason::NoToken) {
    return "messages without a token, most from " + most + ": set the team's token in that client";
  }
  return "too many unauthenticated connections, most from " + most + ": the oldest are closed for new ones";
}

namespace {

alarms::ConnectionSample sample_connection(const forward::Channel& channel) {
  return {.connected = channel.is_connected(),
          .busy = channel.busy(),
          .ended = channel.last().ended_requests(),
          .throttled = channel.last().throttled_answers(),
          .sent = channel.bytes_sent(),
          .status = channel.last().status(),
          .foreign = channel.last().is_foreign(),
          .said = channel.trouble()};
}

/// `row`, with its texts, counts and last answer. `latest`: of the channels, the last that was answered.
facts::EndpointRow endpoint_row(const char* name, const settings::Address& address,
                                std::initializer_list<const forward::Channel*> channels,
                                const forward::Channel& latest, facts::EndpointRow row) {
  if (!latest.has_token()) row = {.fault = facts::EndpointFault::NoToken};
  row.name = name;
  row.address = forward::address_text(address);
  for (const forward::Channel* channel : channels) {
    row.connected |= channel->is_connected();
    if (row.trouble.empty()) row.trouble = channel->trouble();
    row.throttled += channel->last().throttled_answers();
    row.foreign += channel->last().foreign();
  }
  if (row.trouble.empty() && row.fault == facts::EndpointFault::Silent) row.trouble = "no answer";
  row.last_status = latest.last().status();
  row.answer_ms = latest.last().answer_ms();
  if (row.answer_ms) row.answered = latest.last().age();
  return row;
}

struct RobotActivity {
  std::uint64_t accepted = 0, ended = 0;  // ended: delivered or rejected
  journal::Heard heard;
};

/// `now`: stamp clock; `time`: the activities' time of day.
std::map<std::string, RobotActivity> rows_by_robot(const std::vector<facts::ActivityRow>& activities,
                                                   double now, api::Time time) {
  std::map<std::string, RobotActivity> all;
  for (const facts::ActivityRow& row : activities) {
    const auto kind = std::ranges::find(forward::kHeardKinds, row.kind);
    if (kind == std::end(forward::kHeardKinds)) continue;
    RobotActivity& its = all[row.robot];
    its.accepted += row.accepted;
    its.ended += row.forwarded + row.refused_upstream;
    its.heard.robot = row.robot;
    const auto index = static_cast<std::size_t>(kind - std::begin(forward::kHeardKinds));
    auto& [accepted, forwarded] = its.heard.kinds.at(index);
    if (row.last_accepted)
      its.heard.last = std::max(its.heard.last, accepted = now - (time - *row.last_accepted));
    if (row.last_forwarded) forwarded = now - (time - *row.last_forwarded);
    if (row.behind_since) its.heard.behind.at(index) = now - (time - *row.behind_since);
  }
  return all;
}

}  // namespace

void ObservedFacts::restore(const forward::Flow& flow, double now) {
  const auto all = rows_by_robot(flow.activities(), now, now);
  for (const auto& [robot, heard] : flow.heard_before()) {
    const auto its = all.find(robot);
    if (robot.empty() || now - heard.last > alarms::Habits::Rules{}.away) continue;
    habits_.restore(robot,
                    {.messages = static_cast<int>(heard.messages), .gap = heard.gap, .last = heard.last},
                    its == all.end() ? 0 : its->second.accepted);
  }
}

void ObservedFacts::update(forward::Flow& flow, const settings::Settings& settings,
                           const std::vector<facts::ActivityRow>& activities, double now, facts::Time time) {
  scoring_.update({sample_connection(flow.scoring().channel())}, now);
  mapping_.update({sample_connection(flow.maps().channel()), sample_connection(flow.telemetry().channel())},
                  now);
  for (auto& [robot, its] : rows_by_robot(activities, now, time)) {
    habits_.on_count(robot, its.accepted, its.heard.last);
    const std::uint64_t told = its.accepted + its.ended;
    if (std::exchange(told_[robot], told) == told) continue;
    if (const auto habit = habits_.habit_of(robot)) {
      its.heard.messages = static_cast<std::uint64_t>(std::min(habit->messages, alarms::Habits::kMessages));
      its.heard.gap = habit->gap;
      its.heard.last = habit->last;
    }
    flow.keep(its.heard);
  }
  for (const auto& [robot, at] : flow.delivered_scene().earlier_poses()) {
    if (time - at < alarms::Habits::Rules{}.away) habits_.expect(robot, now);
  }
  growth_.update(flow.maps().queued_bytes(), settings.queues.map_bytes, now);
}

std::vector<facts::EndpointRow> ObservedFacts::endpoints(const forward::Flow& flow,
                                                         const settings::CommandPost& command_post,
                                                         double now, facts::Time time) const {
  const forward::Channel& scoring = flow.scoring().channel();
  const forward::Channel& maps = flow.maps().channel();
  const forward::Channel& telemetry = flow.telemetry().channel();
  const forward::Channel& latest =
      maps.last().answer_time() > telemetry.last().answer_time() ? maps : telemetry;
  std::vector rows{
      endpoint_row("scoring", command_post.scoring, {&scoring}, scoring, scoring_.endpoint(now)),
      endpoint_row("mapping", command_post.mapping, {&maps, &telemetry}, latest, mapping_.endpoint(now))};
  for (facts::EndpointRow& row : rows) {
    if (row.since != 0) row.since += time - now;  // 0: unknown
  }
  return rows;
}

facts::Habits ObservedFacts::habits(const settings::Alarms& rules, double now) const {
  const double least = std::chrono::duration<double>(rules.silent_for).count();
  return habits_.robots({.least = least, .times = rules.silent_times}, now);
}

}  // namespace adit::gateway
