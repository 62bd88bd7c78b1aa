// The gateway's view.
#include <algorithm>

#include "alarms/conditions.hpp"
#include "alarms/words.hpp"
#include "api/judged.hpp"
#include "box/version.hpp"
#include "forward/stamp_floor.hpp"
#include "gateway/gateway.hpp"
#include "gateway/report_rows.hpp"
#include "icd/sentence.hpp"
#include "settings/written.hpp"

namespace adit::gateway {
namespace {

constexpr std::size_t kMostReportRows = 200;

}  // namespace

std::vector<api::EndpointRow> Gateway::endpoints() const {
  const forward::Channel& scoring = flow_.scoring().channel();
  const forward::Channel& maps = flow_.maps().channel();
  const forward::Channel& telemetry = flow_.telemetry().channel();
  const forward::Channel& latest = maps.heard() > telemetry.heard() ? maps : telemetry;
  const settings::CommandPost& command_post = settings_.command_post;
  const auto seen = lookout_.endpoints(flow_, command_post, loop_.stamp_now());
  const auto trouble = [](std::string said, const alarms::Endpoint& endpoint) {
    return said.empty() && endpoint.trouble == alarms::PostTrouble::Silent ? "no answer" : said;
  };
  return {{.name = "scoring",
           .address = forward::address_text(command_post.scoring),
           .connected = scoring.connected(),
           .trouble = trouble(scoring.trouble(), seen[0]),
           .last_status = scoring.last_status(),
           .answer_ms = scoring.answer_ms(),
           .throttled = scoring.throttled(),
           .foreign = scoring.foreign()},
          {.name = "mapping",
           .address = forward::address_text(command_post.mapping),
           .connected = maps.connected() || telemetry.connected(),
           .trouble = trouble(maps.trouble().empty() ? telemetry.trouble() : maps.trouble(), seen[1]),
           .last_status = latest.last_status(),
           .answer_ms = latest.answer_ms(),
           .throttled = maps.throttled() + telemetry.throttled(),
           .foreign = maps.foreign() + telemetry.foreign()}};
}

/// For the export. No stamp is used after it.
std::expected<spare::Content, std::string> Gateway::content() const {
  auto ledger = parts_.ledger.copy();
  if (!ledger) return std::unexpected(std::move(ledger.error().what));
  const dispatch::Reports& reports = flow_.reports();
  spare::Content content;
  content.about.name = team_address();
  content.about.version = box::kVersion;
  content.about.stamps = loop_.stamp_now() + forward::StampFloor::kAhead;
  content.about.reports = static_cast<std::int64_t>(reports.book().all().size());
  content.about.open = static_cast<std::int64_t>(reports.book().open().size());
  content.about.post = reports.run().post;
  content.about.run = reports.run().last;
  content.settings = settings::file_of(parts_.loaded.settings);
  content.tokens = {parts_.loaded.secrets.tokens.begin(), parts_.loaded.secrets.tokens.end()};
  content.ledger = *std::move(ledger);
  return content;
}

api::RunView Gateway::view() const {
  api::RunView view{.now = loop_.wall_now(),
                    .version = box::kVersion,
                    .run = flow_.scoring().run(),
                    .run_clock = flow_.scoring().run_clock(),
                    .run_number = flow_.reports().run().number,
                    .run_id = flow_.reports().run().id,
                    .run_seconds = settings_.runs.length_seconds,
                    .endpoints = endpoints(),
                    .robots = flow_.as_forwarded().robots(),
                    .reports = latest_rows(flow_.reports(), kMostReportRows, answers_),
                    .near_metres = settings_.reports.near_metres,
                    .activities = flow_.activities(),
                    .standings = {},
                    .refusals = flow_.record().refusals(),
                    .rejected = flow_.rejected().rows(),
                    .lights = {},
                    .links = links_.rows(),
                    .identify_until = {},
                    .setup_open_until = {},
                    .budget_mbit = settings_.command_post.budget_mbit,
                    .sent_mbit = flow_.sent_mbit(),
                    .queued_bytes = flow_.maps().queued_bytes(),
                    .map_version = flow_.picture().version(),
                    .marker_version = flow_.as_forwarded().markers().version(),
                    .verdict = {},
                    .alarms = {},
                    .alarms_over = board_.over()};
  for (api::ReportRow& row : view.reports) tell_time_of_day(row, loop_);
  judge(view);
  for (const panel::Light light : panel::kLights) {
    view.lights.push_back({.name = std::string(panel::name_of(light)),
                           .pattern = std::string(panel::name_of(lights_.shown()[panel::index_of(light)]))});
  }
  const auto ends = [&view](std::optional<loop::Duration> left) {
    return left ? std::optional(view.now + std::chrono::duration<double>(*left).count()) : std::nullopt;
  };
  view.identify_until = ends(lights_.left(panel::State::Identify));
  view.setup_open_until = ends(accounts_.set_up_left());
  return view;
}

/// Why a restart is harmful now, or "".
std::string Gateway::report_under_way() const {
  const dispatch::Reports& reports = flow_.reports();
  if (const auto* report = reports.sending())
    return icd::sentence("report ", report->number, " is in flight; a restart would leave it in doubt");
  const std::size_t waiting = reports.waiting_here().size();
  if (waiting == 0) return "";
  return icd::sentence(waiting, waiting == 1 ? " report is" : " reports are", " queued");
}

void Gateway::judge(api::RunView& view) const {
  const alarms::Facts found = facts(view.activities);
  view.alarms = board_.shown(alarms::conditions_of(found), found.now);
  api::judge(view, found);
}

std::string Gateway::status_line() const {
  std::string line = flow_.scoring().run()
                         ? "score " + std::to_string(flow_.scoring().run()->score) + ", " +
                               std::to_string(flow_.scoring().run()->remaining_reports) + " reports left"
                         : "no word from the Command Post yet";
  if (const std::size_t waiting = flow_.reports().waiting_here().size(); waiting > 0) {
    line += ", " + std::to_string(waiting) + " reports queued";
  }
  const auto all = alarms();
  if (!all.empty() && alarms::calls(all.front())) line += "; " + alarms::line_of(all.front());
  return line;
}

}  // namespace adit::gateway
