#include "gateway/overview.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "alarms/alarm.hpp"
#include "alarms/conditions.hpp"
#include "api/verdicts.hpp"
#include "box/this_box.hpp"
#include "box/version.hpp"
#include "host/disk.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "loop/guard.hpp"

namespace adit::gateway {

Roster::Roster(const std::vector<settings::Robot>& robots) {
  set_up(robots);
}

void Roster::set_up(const std::vector<settings::Robot>& robots) {
  names_.clear();
  for (const settings::Robot& robot : robots) names_.push_back(robot.name);
  std::erase_if(unknown_, [this](const auto& entry) {
    return names_.empty() || std::ranges::find(names_, entry.first) != names_.end();
  });
}

bool Roster::posted(const std::string& name, loop::Instant now) {
  if (names_.empty() || std::ranges::find(names_, name) != names_.end()) return false;
  if (!unknown_.contains(name) && unknown_.size() >= kMostUnknown) {
    std::erase_if(unknown_, [now](const auto& entry) { return now - entry.second >= kRecent; });
    if (unknown_.size() >= kMostUnknown) return false;
  }
  return unknown_.insert_or_assign(name, now).second;
}

std::vector<std::string> Roster::unknown(loop::Instant now) const {
  std::vector<std::string> names;
  for (const auto& [name, last] : unknown_) {
    if (now - last < kRecent) names.push_back(name);
  }
  return names;
}

std::string Roster::sentence(const std::string& name) const {
  return icd::sentence("unknown robot '", name, "' sends messages; the settings list ", icd::listed(names_));
}

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

alarms::Facts Overview::facts(const std::vector<api::ActivityRow>& activities) const {
  alarms::Facts facts{.now = rooms_.loop.wall_now()};
  facts.streams = api::streams_of(activities, facts.now);
  add_flow(facts);
  add_reports(facts);
  add_box(facts);
  return facts;
}

void Overview::add_flow(alarms::Facts& facts) const {
  const double steady = rooms_.loop.stamp_now();
  facts.endpoints = observed_.endpoints(rooms_.flow, rooms_.settings.command_post, steady);
  for (alarms::Endpoint& each : facts.endpoints) {
    if (each.since != 0) each.since += facts.now - steady;  // 0: unknown
  }
  facts.robots = observed_.robots(rooms_.settings.alarms, steady);
  facts.turn = static_cast<double>(std::ranges::count_if(facts.streams, &alarms::Stream::is_map)) /
               rooms_.settings.command_post.rates.map_hz;
  facts.unknown_robots = roster_.unknown(rooms_.loop.now());
  facts.known_robots = roster_.names();
  facts.crowds = crowding_.crowds(rooms_.loop.now());
  facts.shut_out = rooms_.settings.team.require_token && rooms_.parts.store.unread().empty() &&
                   rooms_.parts.loaded.secrets.tokens.empty();
  facts.queued = rooms_.flow.maps().queued_bytes();
  facts.queue_room = rooms_.settings.queues.map_bytes;
  facts.queue_grows = observed_.queue_grows(steady);
}

void Overview::add_reports(alarms::Facts& facts) const {
  using enum dispatch::ReportState;
  using Is = alarms::ReportFact::Is;
  const dispatch::Reports& reports = rooms_.flow.reports();
  for (const std::int64_t number : reports.book().open()) {
    const dispatch::Report& report = reports.book().at(number);
    if (report.state != Held && report.state != InDoubt) continue;  // not the operator's business
    if (reports.sends_at(report)) continue;
    facts.reports.push_back({.number = report.number,
                             .is = report.state == Held ? Is::Held
                                   : report.is_lost()   ? Is::Lost
                                                        : Is::InDoubt,
                             .asking = reports.is_asking(report),
                             .of_run = report.run == reports.run().number,
                             .note = report.note,
                             .since = time_of_day(report.changed, rooms_.loop)});
  }
  facts.reports_elsewhere = reports.waiting_elsewhere();
  if (rooms_.flow.scoring().run()) facts.reports_left = rooms_.flow.scoring().run()->remaining_reports;
  const std::string& unreliable = reports.run().unreliable;
  if (unreliable != dispatch::Run::kCountsStand) facts.run_unreliable = unreliable;
  facts.run_renamed = reports.runs().name_trouble();
  for (const api::RejectedRow& row : rooms_.flow.rejected().rows()) {
    if (row.replaced || row.status == 0) continue;
    ++facts.messages_rejected;
    if (row.number < facts.newest_rejected) continue;
    facts.newest_rejected = row.number;
    facts.newest_rejected_why = (row.robot.empty() ? "" : row.robot + "'s ") + row.kind + ": " + row.why;
  }
}

void Overview::add_box(alarms::Facts& facts) const {
  for (const api::LinkRow& link : rooms_.links.rows())
    facts.cables.push_back({link.side == "team", link.interface, link.carrier});
  facts.network = rooms_.network.fact();
  facts.ledger_refusal = rooms_.flow.scoring().trouble();
  facts.ledger_damage = rooms_.parts.ledger.damage();
  const std::string other = rooms_.parts.options.state + "/ledger.sqlite";  // of an earlier version
  std::error_code ignored;
  if (std::filesystem::exists(other, ignored)) facts.other_ledger = other;
  facts.ledger_is_closed = rooms_.parts.ledger.is_closed();
  const auto disk = host::disk_of(rooms_.parts.options.state);
  facts.disk = {rooms_.flow.archive().trouble(), rooms_.flow.maps().trouble(), rooms_.flow.journal_trouble(),
                disk ? std::optional(disk->free) : std::nullopt};
  if (rooms_.parts.wear) {
    facts.disk.life = rooms_.parts.wear->life;
    facts.disk.spares = rooms_.parts.wear->spares;
  } else {
    facts.disk.wear_unknown = rooms_.parts.wear.error();
  }
  facts.time_set = rooms_.clock.is_set();
  facts.stamps_ahead = rooms_.flow.clocks().lead();
  facts.stamps_damage = rooms_.flow.clocks().damage();
  facts.ntp_trouble = rooms_.clock.ntp_trouble();
  facts.put_aside = rooms_.parts.put_aside.empty() ? rooms_.flow.put_aside() : rooms_.parts.put_aside;
  facts.change_trouble = rooms_.parts.trouble;
  facts.settings_trouble = rooms_.parts.loaded.trouble;
  facts.board_trouble = rooms_.parts.board_trouble;
  facts.lights_trouble = rooms_.lights.trouble();
  facts.notices = notices_;
  const api::UpdateView update = rooms_.updates.state();
  facts.update.on_trial = update.status.trial;
  facts.update.version = update.status.last.version;
  facts.update.stray = update.status.stray;
  facts.standby = rooms_.spare.standby();
}

}  // namespace adit::gateway
