// Facts for the rules of alarms.
#include <algorithm>
#include <filesystem>
#include <system_error>

#include "api/verdicts.hpp"
#include "gateway/overview.hpp"
#include "host/disk.hpp"

namespace adit::gateway {

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
  const api::UpdateView update = rooms_.updates.update();
  facts.update.on_trial = update.trial;
  facts.update.version = update.last.version;
  facts.update.stray = update.stray;
  facts.standby = rooms_.spare.standby();
}

}  // namespace adit::gateway
