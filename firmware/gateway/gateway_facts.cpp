// Facts for the rules of alarms.
#include <algorithm>

#include "api/judged.hpp"
#include "gateway/gateway.hpp"
#include "gateway/report_rows.hpp"
#include "host/disk.hpp"

namespace adit::gateway {
namespace {

/// nullopt: not the operator's business.
std::optional<alarms::ReportFact> fact_of(const dispatch::Report& report) {
  using enum dispatch::ReportState;
  if (report.state != Held && report.state != InDoubt) return std::nullopt;
  using Is = alarms::ReportFact::Is;
  const bool in_doubt = report.state == InDoubt;
  return alarms::ReportFact{.number = report.number,
                            .is = !in_doubt          ? Is::Held
                                  : report.is_lost() ? Is::Lost
                                                     : Is::InDoubt,
                            .note = report.note,
                            .since = report.changed};
}

}  // namespace

alarms::Facts Gateway::facts(const std::vector<api::ActivityRow>& activities) const {
  alarms::Facts facts{.now = loop_.wall_now()};
  facts.streams = api::streams_of(activities, facts.now);
  add_flow(facts);
  add_reports(facts);
  add_box(facts);
  return facts;
}

void Gateway::add_flow(alarms::Facts& facts) const {
  const double steady = loop_.stamp_now();
  facts.endpoints = lookout_.endpoints(flow_, settings_.command_post, steady);
  for (alarms::Endpoint& each : facts.endpoints) {
    if (each.since != 0) each.since += facts.now - steady;  // 0: unknown
  }
  facts.robots = lookout_.robots(settings_.alarms, steady);
  facts.turn = static_cast<double>(std::ranges::count_if(facts.streams, &alarms::Stream::is_map)) /
               settings_.command_post.rates.map_hz;
  facts.unknown_robots = roster_.unknown(loop_.now());
  facts.known_robots = roster_.names();
  facts.crowds = crowding_.crowds(loop_.now());
  facts.shut_out = icd_options().asks_token && parts_.loaded.secrets.tokens.empty();
  facts.queued = flow_.maps().queued_bytes();
  facts.queue_room = settings_.queues.map_bytes;
  facts.queue_grows = lookout_.queue_grows(steady);
}

void Gateway::add_reports(alarms::Facts& facts) const {
  const dispatch::Reports& reports = flow_.reports();
  for (const std::int64_t number : reports.book().open()) {
    const dispatch::Report& report = reports.book().at(number);
    auto fact = fact_of(report);
    if (!fact) continue;
    fact->since = time_of_day(fact->since, loop_);
    fact->asking = reports.is_asking(report);
    fact->of_run = report.run == reports.run().number;
    facts.reports.push_back(std::move(*fact));
  }
  facts.reports_elsewhere = reports.waiting_elsewhere();
  if (flow_.scoring().run()) facts.reports_left = flow_.scoring().run()->remaining_reports;
  const std::string& unreliable = reports.run().unreliable;
  if (unreliable != dispatch::Run::kCountsStand) facts.run_unreliable = unreliable;
  for (const api::RejectedRow& row : flow_.rejected().rows()) {
    if (row.replaced) continue;
    ++facts.messages_rejected;
    facts.newest_rejected = std::max(facts.newest_rejected, row.number);
  }
}

void Gateway::add_box(alarms::Facts& facts) const {
  for (const api::LinkRow& link : links_.rows())
    facts.cables.push_back({link.side == "team", link.interface, link.carrier});
  facts.network = network_.fact();
  facts.ledger_refusal = flow_.scoring().trouble();
  facts.ledger_damage = parts_.ledger.damage();
  facts.ledger_is_closed = parts_.ledger.is_closed();
  const auto disk = host::disk_of(parts_.options.state);
  facts.disk = {flow_.archive().trouble(), flow_.maps().trouble(), flow_.journal_trouble(),
                disk ? std::optional(disk->free) : std::nullopt};
  facts.time_set = clock_.is_set();
  facts.ntp_trouble = clock_.ntp_trouble();
  facts.put_aside = parts_.put_aside.empty() ? flow_.put_aside() : parts_.put_aside;
  facts.change_trouble = parts_.trouble;
  facts.settings_trouble = parts_.loaded.trouble;
  facts.board_trouble = parts_.board_trouble;
  facts.lights_trouble = lights_.trouble();
  facts.notices = notices_;
  const api::UpdateView update = updates_.update();
  facts.update.on_trial = update.trial;
  facts.update.version = update.last.version;
  facts.update.stray = update.stray;
  facts.standby = spare_.standby();
}

}  // namespace adit::gateway
