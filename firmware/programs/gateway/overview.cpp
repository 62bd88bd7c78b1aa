#include "gateway/overview.hpp"

#include <algorithm>

#include "alarms/alarm.hpp"
#include "alarms/conditions.hpp"
#include "api/verdicts.hpp"
#include "box/notices.hpp"
#include "box/version.hpp"
#include "host/log.hpp"
#include "loop/guard.hpp"

namespace adit::gateway {
namespace {

constexpr std::size_t kMostReportRows = 200;

std::vector<api::ColourRow> chosen_colours(const std::vector<settings::Robot>& robots) {
  std::vector<api::ColourRow> rows;
  for (const settings::Robot& robot : robots) {
    if (robot.colour != 0) rows.push_back({robot.name, robot.colour});
  }
  return rows;
}

}  // namespace

Overview::Overview(const Rooms& rooms, loop::Writer& writer)
    : rooms_(rooms), roster_(rooms.settings.robots), acknowledged_(rooms.parts.options.state, writer) {}

void Overview::carry_on() {
  observed_.carry_on(rooms_.flow, rooms_.loop.stamp_now());
  board_.remember(acknowledged_.read(), rooms_.loop.wall_now());
}

void Overview::look() {
  notices_ = box::read_notices(rooms_.parts.options.notices);
  const auto activities = rooms_.flow.activities();
  observed_.look(rooms_.flow, rooms_.settings, activities, rooms_.loop.stamp_now(), rooms_.loop.wall_now());
  const alarms::Facts found = facts(activities);
  conditions_ = alarms::conditions_of(found);
  looked_at_ = found.now;
  board_.take(conditions_, looked_at_);
  // At a stop conditions end that are not cleared.
  if (!rooms_.flow.is_ending()) acknowledged_.keep(board_.acknowledged());
  std::vector<std::string> headlines;
  for (const alarms::Condition& each : conditions_) {
    if (each.severity != alarms::Severity::Wait) headlines.push_back(each.headline.now());
  }
  rooms_.flow.archive().needs_attention(headlines, looked_at_);
  log_crowding();
}

std::expected<void, std::string> Overview::acknowledge(const std::string& id) {
  look();
  auto done = board_.acknowledge(id, looked_at_);
  acknowledged_.keep(board_.acknowledged());
  return done;
}

void Overview::show_on(box::Lights& lights) const {
  using panel::State;
  const bool serving = rooms_.listeners.serves() && rooms_.flow.scoring().trouble().empty();
  lights.set(State::Serving, serving);
  lights.set(State::NotServing, !serving);
  const auto posts = endpoints();
  lights.set(State::ScoringConnected, posts[0].connected);
  lights.set(State::ScoringFailing, !posts[0].trouble.empty());
  lights.set(State::ReportWaiting, !rooms_.flow.reports().waiting_here().empty());
  lights.set(State::MappingConnected, posts[1].connected);
  lights.set(State::MappingFailing, !posts[1].trouble.empty());
  const auto all = alarms();
  const auto calling = std::ranges::count_if(all, alarms::calls);
  const auto seen = std::ranges::count_if(
      all, [](const alarms::Alarm& alarm) { return alarms::calls(alarm) && alarm.acknowledged; });
  lights.set(State::NeedsOperator, calling > seen);
  lights.set(State::Acknowledged, calling > 0);
  lights.set(State::UpdateRunning, rooms_.updates.running());
  for (const api::LinkRow& link : rooms_.links.rows()) {
    lights.set(link.side == "team" ? State::TeamUnplugged : State::CommandPostUnplugged,
               !link.carrier.value_or(false));
  }
  if (lights.has(State::SetUpOpen) && !rooms_.accounts.set_up_open()) {
    host::log(host::Level::Notice, "set-up is closed");
  }
  lights.set(State::SetUpOpen, rooms_.accounts.set_up_open());
}

void Overview::posted(const std::string& robot) {
  if (roster_.posted(robot, rooms_.loop.now())) host::log(host::Level::Warning, roster_.sentence(robot));
}

void Overview::ended(intake::Ended why, const std::string& address) {
  crowding_.ended(why, address, rooms_.loop.now());
  log_crowding();
}

void Overview::settings_changed(const settings::Restarts& restarts) {
  if (restarts.scoring) observed_.forget_scoring();
  if (restarts.mapping) observed_.forget_mapping();
  roster_.set_up(rooms_.settings.robots);
}

void Overview::log_crowding() {
  for (const Crowding::Line& line : crowding_.to_log(rooms_.loop.now()))
    host::log(host::Level::Warning, line.sentence, {{"times", std::to_string(line.times)}});
}

std::vector<api::EndpointRow> Overview::endpoints() const {
  const forward::Channel& scoring = rooms_.flow.scoring().channel();
  const forward::Channel& maps = rooms_.flow.maps().channel();
  const forward::Channel& telemetry = rooms_.flow.telemetry().channel();
  const forward::Channel& latest = maps.last().heard() > telemetry.last().heard() ? maps : telemetry;
  const settings::CommandPost& command_post = rooms_.settings.command_post;
  const auto seen = observed_.endpoints(rooms_.flow, command_post, rooms_.loop.stamp_now());
  const auto trouble = [](std::string said, const alarms::Endpoint& endpoint) {
    return said.empty() && endpoint.trouble == alarms::EndpointTrouble::Silent ? "no answer" : said;
  };
  return {{.name = "scoring",
           .address = forward::address_text(command_post.scoring),
           .connected = scoring.connected(),
           .trouble = trouble(scoring.trouble(), seen[0]),
           .last_status = scoring.last().status(),
           .answer_ms = scoring.last().answer_ms(),
           .throttled = scoring.last().throttled(),
           .foreign = scoring.last().foreign()},
          {.name = "mapping",
           .address = forward::address_text(command_post.mapping),
           .connected = maps.connected() || telemetry.connected(),
           .trouble = trouble(maps.trouble().empty() ? telemetry.trouble() : maps.trouble(), seen[1]),
           .last_status = latest.last().status(),
           .answer_ms = latest.last().answer_ms(),
           .throttled = maps.last().throttled() + telemetry.last().throttled(),
           .foreign = maps.last().foreign() + telemetry.last().foreign()}};
}

api::RunView Overview::view() const {
  const double now = rooms_.loop.wall_now();
  const auto ends = [now](std::optional<loop::Duration> left) {
    return left ? std::optional(now + std::chrono::duration<double>(*left).count()) : std::nullopt;
  };
  api::RunView view{.now = now,
                    .version = box::kVersion,
                    .run = rooms_.flow.scoring().run(),
                    .run_clock = rooms_.flow.scoring().run_clock(),
                    .run_number = rooms_.flow.reports().run().number,
                    .run_id = rooms_.flow.reports().run().id,
                    .run_seconds = rooms_.settings.runs.length_seconds,
                    .endpoints = endpoints(),
                    .robots = rooms_.flow.delivered().robots(),
                    .reports = latest_rows(rooms_.flow.reports(), kMostReportRows, answers_),
                    .near_metres = rooms_.settings.reports.near_metres,
                    .activities = rooms_.flow.activities(),
                    .standings = {},
                    .colours = chosen_colours(rooms_.settings.robots),
                    .refusals = rooms_.flow.counts().refusals(),
                    .rejected = rooms_.flow.rejected().rows(),
                    .lights = {},
                    .links = rooms_.links.rows(),
                    .identify_until = ends(rooms_.lights.left(panel::State::Identify)),
                    .setup_open_until = ends(rooms_.accounts.set_up_left()),
                    .budget_mbit = rooms_.settings.command_post.budget_mbit,
                    .sent_mbit = rooms_.flow.sent_mbit(),
                    .queued_bytes = rooms_.flow.maps().queued_bytes(),
                    .map_version = rooms_.flow.picture().version(),
                    .marker_version = rooms_.flow.delivered().markers().version(),
                    .verdict = {},
                    .alarms = {},
                    .alarms_over = board_.over()};
  for (api::ReportRow& row : view.reports) tell_time_of_day(row, rooms_.loop);
  const alarms::Facts found = facts(view.activities);
  view.alarms = board_.shown(alarms::conditions_of(found), found.now);
  api::add_verdicts(view, found);
  for (const panel::Light light : panel::kLights) {
    view.lights.push_back(
        {.name = std::string(panel::name_of(light)),
         .pattern = std::string(panel::name_of(rooms_.lights.shown()[panel::index_of(light)]))});
  }
  return view;
}

std::string Overview::status_line() const {
  std::string line = rooms_.flow.scoring().run()
                         ? "score " + std::to_string(rooms_.flow.scoring().run()->score) + ", " +
                               std::to_string(rooms_.flow.scoring().run()->remaining_reports) +
                               " reports left"
                         : "no word from the Command Post yet";
  if (const std::size_t waiting = rooms_.flow.reports().waiting_here().size(); waiting > 0) {
    line += ", " + std::to_string(waiting) + " reports queued";
  }
  const auto all = alarms();
  if (!all.empty() && alarms::calls(all.front())) line += "; " + alarms::line_of(all.front());
  return line;
}

std::vector<api::ReportRow> Overview::reports(std::int64_t after, std::size_t most) const {
  auto rows = rows_after(rooms_.flow.reports(), after, most);
  for (api::ReportRow& row : rows) tell_time_of_day(row, rooms_.loop);
  return rows;
}

std::optional<api::ReportDetail> Overview::report(std::int64_t number) const {
  auto detail = detail_of(rooms_.flow.reports(), rooms_.parts.ledger, number);
  if (!detail) return detail;
  tell_time_of_day(detail->row, rooms_.loop);
  for (auto& step : detail->history) step.at = time_of_day(step.at, rooms_.loop);
  return detail;
}

void Overview::add_to(api::Usage& usage) const {
  usage.connections += rooms_.listeners.connections();
  usage.unauthenticated = rooms_.listeners.unauthenticated();
  usage.ended = {{"no_room", crowding_.count(intake::Ended::NoRoom)},
                 {"gave_way", crowding_.count(intake::Ended::GaveWay)},
                 {"idle", crowding_.count(intake::Ended::Idle)},
                 {"slow", crowding_.count(intake::Ended::Slow)}};
  usage.wrong_tokens = crowding_.count(intake::Ended::WrongToken);
  usage.sent_bytes = rooms_.flow.sent_bytes();
  usage.exceptions = loop::caught_so_far();
  usage.rejected_dropped = rooms_.flow.rejected().dropped();
  usage.refused = rooms_.flow.counts().refused_counts();
}

}  // namespace adit::gateway
