// What the gateway shows of itself.
#include "gateway/gateway.hpp"
#include "gateway/report_rows.hpp"
#include "gateway/version.hpp"

namespace adit::gateway {
namespace {

constexpr std::size_t kMostReportRows = 200;

}  // namespace

double Gateway::sent_mbit() const {
  if (bytes_sent_.size() < 2) return 0;
  const auto bytes = static_cast<double>(bytes_sent_.back() - bytes_sent_.front());
  return bytes * 8 / 1e6 / static_cast<double>(bytes_sent_.size() - 1);
}

std::vector<page::EndpointRow> Gateway::endpoints() const {
  const forward::Channel& scoring = scoring_.channel();
  const forward::Channel& maps = maps_.channel();
  const forward::Channel& news = news_.channel();
  const forward::Channel& latest = maps.heard() > news.heard() ? maps : news;
  const settings::CommandPost& command_post = settings_.command_post;
  return {{.name = "scoring",
           .address = forward::address_text(command_post.scoring),
           .connected = scoring.connected(),
           .trouble = scoring.trouble(),
           .last_status = scoring.last_status(),
           .answer_ms = scoring.answer_ms(),
           .throttled = scoring.throttled(),
           .foreign = scoring.foreign()},
          {.name = "mapping",
           .address = forward::address_text(command_post.mapping),
           .connected = maps.connected() || news.connected(),
           .trouble = maps.trouble().empty() ? news.trouble() : maps.trouble(),
           .last_status = latest.last_status(),
           .answer_ms = latest.answer_ms(),
           .throttled = maps.throttled() + news.throttled(),
           .foreign = maps.foreign() + news.foreign()}};
}

page::RunView Gateway::view() const {
  page::RunView view{.now = loop_.stamp_now(),
                     .version = kVersion,
                     .run = scoring_.run(),
                     .run_heard = scoring_.run_heard(),
                     .run_number = scoring_.reports().run().number,
                     .run_id = scoring_.reports().run().id,
                     .endpoints = endpoints(),
                     .robots = as_forwarded_.robots(),
                     .reports = latest_rows(scoring_.reports(), kMostReportRows),
                     .near_metres = settings_.reports.near_metres,
                     .activities = record_.activities(),
                     .refusals = record_.refusals(),
                     .aside = aside_.rows(),
                     .lights = {},
                     .links = links_.rows(),
                     .identify_until = {},
                     .setup_open_until = {},
                     .budget_mbit = settings_.command_post.budget_mbit,
                     .sent_mbit = sent_mbit(),
                     .queued_bytes = maps_.queued_bytes(),
                     .map_version = picture_.mosaic().version(),
                     .marker_version = as_forwarded_.markers().version(),
                     .attention = attention()};
  for (page::ActivityRow& row : view.activities) {
    if (row.kind == "state") row.waiting = news_.waiting(forward::Kind::State);
    if (row.kind == "markers") row.waiting = news_.waiting(forward::Kind::Markers);
    if (row.kind == "grid") row.waiting = maps_.waiting({forward::Kind::Grid, row.robot});
    if (row.kind == "cloud") row.waiting = maps_.waiting({forward::Kind::Cloud, row.robot});
  }
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

std::string Gateway::status_line() const {
  std::string line = scoring_.run() ? "score " + std::to_string(scoring_.run()->score) + ", " +
                                          std::to_string(scoring_.run()->remaining_reports) + " reports left"
                                    : "no word from the Command Post yet";
  if (const std::size_t waiting = scoring_.reports().waiting_here().size(); waiting > 0) {
    line += ", " + std::to_string(waiting) + " reports waiting";
  }
  if (const auto sentences = attention(); !sentences.empty()) line += "; " + sentences.front();
  return line;
}

}  // namespace adit::gateway
