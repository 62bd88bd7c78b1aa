#include "gateway/overview.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "alarms/alarm.hpp"
#include "alarms/conditions.hpp"
#include "alarms/verdict.hpp"
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

bool Roster::on_posted(const std::string& name, loop::Instant now) {
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
  return icd::sentence("unknown robot '", name, "' sends messages; the settings list ",
                       icd::join_words(names_));
}

namespace {

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

void Overview::restore() {
  observed_.restore(rooms_.flow, rooms_.loop.stamp_now());
  board_.remember(acknowledged_.read(), rooms_.loop.wall_now());
}

void Overview::update() {
  notices_ = box::read_notices(rooms_.parts.options.notices);
  auto activities = rooms_.flow.activities();
  observed_.update(rooms_.flow, rooms_.settings, activities, rooms_.loop.stamp_now(), rooms_.loop.wall_now());
  take_snapshot(std::move(activities));
  // At a stop conditions end that are not cleared.
  if (!rooms_.flow.is_ending()) acknowledged_.keep(board_.acknowledgements());
  std::vector<std::string> headlines;
  for (const alarms::Condition& each : conditions_) {
    if (each.severity != alarms::Severity::Wait) headlines.push_back(each.headline.now());
  }
  rooms_.flow.archive().set_attention(headlines, view_.now);
  log_crowding();
}

std::expected<void, std::string> Overview::acknowledge(const std::string& id) {
  take_snapshot(rooms_.flow.activities());
  auto done = board_.acknowledge(id, view_.now);
  view_.alarms = board_.to_alarms(conditions_, view_.now);
  acknowledged_.keep(board_.acknowledgements());
  return done;
}

void Overview::show_on(box::Lights& lights) const {
  using panel::LightState;
  const bool serving = rooms_.listeners.serves() && rooms_.flow.scoring().trouble().empty();
  lights.set(LightState::Serving, serving);
  lights.set(LightState::NotServing, !serving);
  const auto& posts = view_.endpoints;
  lights.set(LightState::ScoringConnected, posts[0].connected);
  lights.set(LightState::ScoringFailing, !posts[0].trouble.empty());
  lights.set(LightState::ReportWaiting, !rooms_.flow.reports().waiting_here().empty());
  lights.set(LightState::MappingConnected, posts[1].connected);
  lights.set(LightState::MappingFailing, !posts[1].trouble.empty());
  const auto& all = view_.alarms;
  const auto calling = std::ranges::count_if(all, alarms::calls);
  const auto seen = std::ranges::count_if(
      all, [](const alarms::Alarm& alarm) { return alarms::calls(alarm) && alarm.acknowledged; });
  lights.set(LightState::NeedsOperator, calling > seen);
  lights.set(LightState::Acknowledged, calling > 0);
  lights.set(LightState::UpdateRunning, rooms_.updates.running());
  for (const facts::LinkRow& link : view_.links) {
    lights.set(link.is_team() ? LightState::TeamUnplugged : LightState::CommandPostUnplugged,
               !link.carrier.value_or(false));
  }
  if (lights.has(LightState::SetUpOpen) && !rooms_.accounts.set_up_open()) {
    host::log(host::Level::Notice, "set-up is closed");
  }
  lights.set(LightState::SetUpOpen, rooms_.accounts.set_up_open());
}

void Overview::on_posted(const std::string& robot) {
  if (roster_.on_posted(robot, rooms_.loop.now())) host::log(host::Level::Warning, roster_.sentence(robot));
}

void Overview::on_ended(intake::CloseReason why, const std::string& address) {
  crowding_.on_ended(why, address, rooms_.loop.now());
  log_crowding();
}

void Overview::on_settings_changed(const settings::Restarts& restarts) {
  if (restarts.scoring) observed_.forget_scoring();
  if (restarts.mapping) observed_.forget_mapping();
  roster_.set_up(rooms_.settings.robots);
}

void Overview::log_crowding() {
  for (const Crowding::Line& line : crowding_.to_log(rooms_.loop.now()))
    host::log(host::Level::Warning, line.sentence, {{"times", std::to_string(line.times)}});
}

api::RunView Overview::view() {
  take_snapshot(rooms_.flow.activities());
  return view_;
}

void Overview::take_snapshot(std::vector<facts::ActivityRow> activities) {
  facts::Snapshot snapshot{.traffic = traffic(std::move(activities)),
                           .clients = clients(),
                           .reports = reports(),
                           .network = rooms_.network.fact(),
                           .box = box()};
  conditions_ = alarms::conditions_of(snapshot);
  board_.update(conditions_, snapshot.traffic.now);
  view_ = view_of(std::move(snapshot));
}

api::RunView Overview::view_of(facts::Snapshot snapshot) const {
  facts::Traffic& traffic = snapshot.traffic;
  const double now = traffic.now;
  auto shown = board_.to_alarms(conditions_, now);
  alarms::add_words(traffic, shown);
  const auto ends = [now](std::optional<loop::Duration> left) {
    return left ? std::optional(now + std::chrono::duration<double>(*left).count()) : std::nullopt;
  };
  auto& reports = snapshot.reports.rows;
  reports.resize(std::min(reports.size(), api::RunView::kMostReports));
  auto verdict = alarms::verdict_of(traffic);
  const api::CertificateView certificate = rooms_.certificate.state();
  api::RunView view{.now = now,
                    .version = box::kVersion,
                    .run = rooms_.flow.scoring().run(),
                    .run_clock = rooms_.flow.scoring().run_clock(),
                    .run_number = rooms_.flow.reports().run().number,
                    .run_id = rooms_.flow.reports().run().id,
                    .run_seconds = rooms_.settings.runs.length_seconds,
                    .endpoints = std::move(traffic.endpoints),
                    .robots = std::move(traffic.robots),
                    .reports = std::move(reports),
                    .near_metres = rooms_.settings.reports.near_metres,
                    .activities = std::move(traffic.activities),
                    .standings = std::move(traffic.standings),
                    .colours = chosen_colours(rooms_.settings.robots),
                    .refusals = rooms_.flow.counts().refusals(),
                    .rejected = std::move(snapshot.reports.rejected),
                    .lights = {},
                    .links = std::move(traffic.links),
                    .certificate = certificate.offered ? certificate.fingerprint : "",
                    .identify_until = ends(rooms_.lights.remaining(panel::LightState::Identify)),
                    .setup_open_until = ends(rooms_.accounts.set_up_left()),
                    .budget_mbit = rooms_.settings.command_post.budget_mbit,
                    .sent_mbit = rooms_.flow.sent_mbit(),
                    .queued_bytes = traffic.queued,
                    .map_version = rooms_.flow.picture().version(),
                    .marker_version = rooms_.flow.delivered_scene().markers().version(),
                    .verdict = std::move(verdict),
                    .alarms = std::move(shown),
                    .alarms_over = board_.ended_alarms()};
  for (const panel::Light light : panel::kLights) {
    view.lights.push_back(
        {.name = std::string(panel::name_of(light)),
         .pattern = std::string(panel::name_of(rooms_.lights.shown_lights()[panel::index_of(light)]))});
  }
  return view;
}

std::string Overview::status_line() const {
  std::string line = view_.run ? icd::sentence("score ", view_.run->score, ", ", view_.run->remaining_reports,
                                               " reports left")
                               : "no word from the Command Post yet";
  if (const std::size_t waiting = rooms_.flow.reports().waiting_here().size(); waiting > 0) {
    line += ", " + std::to_string(waiting) + " reports queued";
  }
  const auto& all = view_.alarms;
  if (!all.empty() && alarms::calls(all.front())) line += "; " + alarms::line_of(all.front());
  return line;
}

std::vector<facts::ReportRow> Overview::reports(std::int64_t after, std::size_t most) const {
  auto rows = rows_after(rooms_.flow.reports(), after, most);
  for (facts::ReportRow& row : rows) set_time_of_day(row, rooms_.flow.clocks());
  return rows;
}

std::optional<api::ReportDetail> Overview::report(std::int64_t number) const {
  auto detail = detail_of(rooms_.flow.reports(), rooms_.parts.ledger, number);
  if (!detail) return detail;
  set_time_of_day(detail->row, rooms_.flow.clocks());
  for (auto& step : detail->history) step.at = rooms_.flow.clocks().time_of_day(step.at);
  return detail;
}

void Overview::add_to(api::Usage& usage) const {
  usage.connections += rooms_.listeners.connections();
  usage.unauthenticated = rooms_.listeners.unauthenticated_connections();
  usage.ended = {{"no_room", crowding_.count(intake::CloseReason::NoRoom)},
                 {"gave_way", crowding_.count(intake::CloseReason::GaveWay)},
                 {"idle", crowding_.count(intake::CloseReason::Idle)},
                 {"slow", crowding_.count(intake::CloseReason::Slow)}};
  usage.wrong_tokens = crowding_.count(intake::CloseReason::WrongToken);
  usage.sent_bytes = rooms_.flow.sent_bytes();
  usage.exceptions = loop::exception_count();
  usage.rejected_dropped = rooms_.flow.rejected_store().dropped_count();
  usage.refused = rooms_.flow.counts().refused_counts();
}

facts::Traffic Overview::traffic(std::vector<facts::ActivityRow> activities) const {
  const double now = rooms_.loop.wall_now(), steady = rooms_.loop.stamp_now();
  facts::Traffic traffic{
      .now = now,
      .endpoints = observed_.endpoints(rooms_.flow, rooms_.settings.command_post, steady, now),
      .links = rooms_.links.rows(),
      .activities = std::move(activities),
      .habits = observed_.habits(rooms_.settings.alarms, steady),
      .robots = rooms_.flow.delivered_scene().robots(),
      .registered = roster_.names(),
      .queued = rooms_.flow.maps().queued_bytes(),
      .queue_room = rooms_.settings.queues.map_bytes,
      .queue_grows = observed_.is_queue_growing(steady)};
  traffic.turn = static_cast<double>(std::ranges::count_if(traffic.activities, &facts::ActivityRow::is_map)) /
                 rooms_.settings.command_post.rates.map_hz;
  return traffic;
}

facts::Clients Overview::clients() const {
  return {.unknown_robots = roster_.unknown(rooms_.loop.now()),
          .crowds = crowding_.crowds(rooms_.loop.now()),
          .shut_out = rooms_.settings.team.require_token && rooms_.parts.store.unread().empty() &&
                      rooms_.parts.loaded.secrets.tokens.empty()};
}

facts::Reports Overview::reports() const {
  const dispatch::Reports& all = rooms_.flow.reports();
  facts::Reports reports{.rows = latest_rows(all, api::RunView::kMostReports, answers_),
                         .elsewhere = all.waiting_elsewhere(),
                         .run_renamed = all.runs().name_trouble(),
                         .rejected = rooms_.flow.rejected_store().rows()};
  for (facts::ReportRow& row : reports.rows) set_time_of_day(row, rooms_.flow.clocks());
  for (const dispatch::Report* const lost : all.lost_reports()) reports.lost_here.insert(lost->number);
  if (const auto& run = rooms_.flow.scoring().run()) reports.left = run->remaining_reports;
  if (all.run().unreliable != dispatch::Run::kCountsStand) reports.run_unreliable = all.run().unreliable;
  return reports;
}

facts::Box Overview::box() const {
  facts::Box box;
  box.ledger_refusal = rooms_.flow.scoring().trouble();
  box.ledger_damage = rooms_.parts.ledger.damage();
  const std::string other = rooms_.parts.options.state + "/ledger.sqlite";  // of an earlier version
  std::error_code ignored;
  if (std::filesystem::exists(other, ignored)) box.other_ledger = other;
  box.ledger_is_closed = rooms_.parts.ledger.is_closed();
  const auto disk = host::disk_of(rooms_.parts.options.state);
  box.disk = {rooms_.flow.archive().trouble(), rooms_.flow.maps().trouble(), rooms_.flow.journal_trouble(),
              disk ? std::optional(disk->free) : std::nullopt};
  if (rooms_.parts.wear) {
    box.disk.life = rooms_.parts.wear->life;
    box.disk.spares = rooms_.parts.wear->spares;
  } else {
    box.disk.wear_unknown = rooms_.parts.wear.error();
  }
  box.time_set = rooms_.clock.is_set();
  box.stamps_ahead = rooms_.flow.clocks().lead();
  box.stamps_damage = rooms_.flow.clocks().damage();
  box.ntp_trouble = rooms_.clock.ntp_trouble();
  box.put_aside = rooms_.parts.put_aside.empty() ? rooms_.flow.put_aside() : rooms_.parts.put_aside;
  box.change_trouble = rooms_.parts.trouble;
  box.settings_trouble = rooms_.parts.loaded.trouble;
  box.board_trouble = rooms_.parts.board_trouble;
  box.lights_trouble = rooms_.lights.trouble();
  box.notices = notices_;
  const api::UpdateView update = rooms_.updates.state();
  box.update.on_trial = update.status.trial;
  box.update.version = update.status.last.version;
  box.update.stray = update.status.stray;
  box.standby = rooms_.spare.standby();
  return box;
}

}  // namespace adit::gateway
