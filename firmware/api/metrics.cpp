#include "api/metrics.hpp"

#include <algorithm>

#include "api/exposition.hpp"
#include "api/judged.hpp"
#include "dispatch/report_life.hpp"

namespace adit::api {
namespace {

constexpr double kBytesPerMbit = 1e6 / 8;

double number(std::uint64_t value) {
  return static_cast<double>(value);
}

void write_box(Exposition& out, const Measured& measured) {
  const Usage& usage = measured.usage;
  out.gauge("adit_build_info", "The program that runs; always 1.");
  out.sample({{"version", measured.about.version}, {"build", measured.about.build}}, 1);
  out.gauge("adit_process_start_time_seconds", "When the process began, in seconds since 1970.");
  out.sample(usage.started);
  out.counter("adit_process_cpu_seconds_total", "Processor time that the process used.");
  out.sample(usage.cpu_seconds);
  out.gauge("adit_process_resident_memory_bytes", "Memory that the process holds.");
  out.sample(number(usage.resident_bytes));
  out.gauge("adit_process_open_fds", "File descriptors that are open.");
  out.sample(number(usage.open_files));
  out.gauge("adit_process_max_fds", "File descriptors that may be open.");
  out.sample(number(usage.most_files));
  out.gauge("adit_process_threads", "Threads of the process.");
  out.sample(number(usage.threads));
  out.gauge("adit_connections", "Connections of the team's side.");
  out.sample(number(usage.connections));
  out.gauge("adit_connections_strangers", "Those of them that have shown no token and no session.");
  out.sample(number(usage.strangers));
  out.counter(
      "adit_connections_ended_total",
      "Connections that Adit did not go on with: no_room (the request was answered 503), gave_way and idle "
      "(for another), slow.");
  for (const EndedCount& row : usage.ended) out.sample({{"why", row.why}}, number(row.count));
  out.counter(
      "adit_wrong_tokens_total",
      "Requests with a wrong token, with none where one is asked for, or with one that was not looked at "
      "after too many of those.");
  out.sample(number(usage.wrong_tokens));
  out.counter("adit_exceptions_total", "Requests, answers and jobs that were ended by an exception.");
  out.sample(number(usage.exceptions));
  out.gauge("adit_sessions", "Logins that have not ended.");
  out.sample({{"role", "operator"}}, number(measured.operators));
  out.sample({{"role", "viewer"}}, number(measured.viewers));
  out.gauge("adit_light", "The lights on the box, each with its pattern; always 1.");
  for (const LightRow& light : measured.view.lights) {
    out.sample({{"light", light.name}, {"pattern", light.pattern}}, 1);
  }
}

void write_alarms(Exposition& out, const std::vector<alarms::Alarm>& all) {
  out.gauge("adit_alarm", "What is not as it should be; always 1.");
  for (const alarms::Alarm& alarm : all) {
    out.sample({{"id", alarm.id},
                {"severity", std::string(alarms::kSeverityWords[static_cast<std::size_t>(alarm.severity)])},
                {"side", std::string(alarms::kSideWords[static_cast<std::size_t>(alarm.side)])}},
               1);
  }
  out.gauge("adit_alarms", "How many alarms there are of each severity.");
  for (std::size_t i = 0; i < std::size(alarms::kSeverityWords); ++i) {
    const auto severity = static_cast<alarms::Severity>(i);
    out.sample({{"severity", std::string(alarms::kSeverityWords[i])}},
               number(static_cast<std::size_t>(std::ranges::count(all, severity, &alarms::Alarm::severity))));
  }
}

void write_run(Exposition& out, const RunView& view) {
  out.gauge("adit_run_number", "The run, as Adit counts them.");
  out.sample(static_cast<double>(view.run_number));
  if (!view.run) return;
  out.gauge("adit_run_info", "The run as the Command Post names it; always 1.");
  out.sample({{"team", view.run->current_team}, {"run", view.run_id}}, 1);
  out.gauge("adit_run_clock_seconds", "The run's clock, as last heard.");
  out.sample(static_cast<double>(view.run->run_clock));
  out.gauge("adit_run_score", "The team's score, as last heard.");
  out.sample(static_cast<double>(view.run->score));
  out.gauge("adit_run_remaining_reports", "Reports that are left, as last heard.");
  out.sample(static_cast<double>(view.run->remaining_reports));
  if (!view.run_heard) return;
  out.gauge("adit_run_heard_age_seconds", "How long ago the run's status was heard.");
  out.sample(view.now - *view.run_heard);
}

void write_reports(Exposition& out, const ReportCounts& reports) {
  out.gauge("adit_reports", "Artifact reports of all runs, by where they are in their lives.");
  for (std::size_t i = 0; i < reports.in.size(); ++i) {
    out.sample({{"state", std::string(dispatch::kStateWords[i])}}, number(reports.in[i]));
  }
  out.gauge("adit_reports_asking", "Reports in doubt of which Adit is finding out what became.");
  out.sample(number(reports.asking));
}

void write_endpoints(Exposition& out, const RunView& view) {
  out.gauge("adit_endpoint_up", "1 where there is a connection to the Command Post's endpoint, else 0.");
  for (const EndpointRow& row : view.endpoints) out.sample({{"endpoint", row.name}}, row.connected ? 1 : 0);
  out.gauge("adit_endpoint_answer_seconds", "How long the endpoint's last answer took.");
  for (const EndpointRow& row : view.endpoints) {
    if (row.answer_ms) out.sample({{"endpoint", row.name}}, *row.answer_ms / 1000);
  }
  out.gauge("adit_endpoint_last_status", "The HTTP status of the last request's answer; 0: none came.");
  for (const EndpointRow& row : view.endpoints) out.sample({{"endpoint", row.name}}, row.last_status);
  out.counter("adit_endpoint_throttled_total", "Answers of 429.");
  for (const EndpointRow& row : view.endpoints) out.sample({{"endpoint", row.name}}, number(row.throttled));
  out.counter("adit_endpoint_foreign_total", "Answers that no Command Post gives: pages of HTML, redirects.");
  for (const EndpointRow& row : view.endpoints) out.sample({{"endpoint", row.name}}, number(row.foreign));
}

void write_link(Exposition& out, const Measured& measured) {
  out.counter("adit_link_sent_bytes_total", "Bytes of bodies sent to both endpoints.");
  out.sample(number(measured.usage.sent_bytes));
  out.gauge("adit_link_rate_bytes_per_second", "The same over the last seconds.");
  out.sample(measured.view.sent_mbit * kBytesPerMbit);
  out.gauge("adit_link_budget_bytes_per_second", "What the link may be used for; 0: no limit is set.");
  out.sample(measured.view.budget_mbit * kBytesPerMbit);
  out.gauge("adit_queue_bytes", "Bytes of maps that wait.");
  out.sample(number(measured.view.queued_bytes));
  out.gauge("adit_rejected_messages",
            "Messages that the Command Post would not take and nothing newer has replaced.");
  out.sample(number(
      static_cast<std::size_t>(std::ranges::count(measured.view.rejected, false, &RejectedRow::replaced))));
  out.counter("adit_rejected_messages_dropped_total", "Messages rejected that made place for newer ones.");
  out.sample(number(measured.usage.rejected_dropped));
}

/// Of each robot and kind.
void sample_each(Exposition& out, const RunView& view, std::uint64_t ActivityRow::* count) {
  for (const ActivityRow& row : view.activities) {
    out.sample({{"kind", row.kind}, {"robot", row.robot}}, number(row.*count));
  }
}

void write_counter(Exposition& out, const RunView& view, const char* name, const char* help,
                   std::uint64_t ActivityRow::* count) {
  out.counter(name, help);
  sample_each(out, view, count);
}

void write_updates(Exposition& out, const RunView& view) {
  write_counter(out, view, "adit_updates_accepted_total", "Updates taken from the team.",
                &ActivityRow::accepted);
  write_counter(out, view, "adit_updates_forwarded_total", "Updates that the Command Post took.",
                &ActivityRow::forwarded);
  write_counter(out, view, "adit_updates_replaced_total",
                "Updates that did not go, for others say all of theirs.", &ActivityRow::replaced);
  write_counter(out, view, "adit_updates_merged_total", "Updates that went as parts of others.",
                &ActivityRow::merged);
  write_counter(out, view, "adit_updates_throttled_total", "Answers of 429, after which it went again.",
                &ActivityRow::throttled);
  write_counter(out, view, "adit_updates_failed_total", "Tries without an answer, after which it went again.",
                &ActivityRow::failed);
  write_counter(out, view, "adit_updates_refused_total", "Updates that the Command Post refused for good.",
                &ActivityRow::refused_upstream);
  write_counter(out, view, "adit_updates_no_room_total", "Updates refused to robots, because too much waits.",
                &ActivityRow::no_room);
  out.gauge("adit_updates_behind_seconds",
            "For how long the Command Post has lacked the oldest news; 0: it has all.");
  for (const ActivityRow& row : view.activities) {
    out.sample({{"kind", row.kind}, {"robot", row.robot}}, row.behind.value_or(0));
  }
  out.gauge("adit_updates_arrive", "Whether they reach the Command Post, by the word on the page; always 1.");
  for (const ActivityRow& row : view.activities) {
    out.sample({{"kind", row.kind}, {"robot", row.robot}, {"arrival", std::string(name_of(row.arrival))}}, 1);
  }
  out.gauge("adit_clouds_whole",
            "Whether its newest cloud replaces those that wait (1), or each arrives (0).");
  for (const ActivityRow& row : view.activities) {
    if (!row.clouds.empty()) out.sample({{"robot", row.robot}}, row.clouds == "whole" ? 1 : 0);
  }
  out.gauge("adit_clouds_rounded_metres",
            "Steps to which the coordinates of the last cloud that went were rounded; 0: it was exact.");
  for (const ActivityRow& row : view.activities) {
    if (row.precision.empty()) continue;
    out.sample({{"robot", row.robot}}, row.precision == "1mm" ? 0.001 : row.precision == "8mm" ? 0.008 : 0);
  }
  out.counter("adit_points_left_out_total",
              "Points that were not sent, for another of their voxel was, or was taken by the Command Post.");
  for (const ActivityRow& row : view.activities) {
    if (row.kind == "cloud") out.sample({{"robot", row.robot}}, number(row.points_left_out));
  }
  out.counter("adit_clouds_no_valid_point_total",
              "Clouds taken from the team that did not go, for each of their points is NaN or infinite.");
  for (const ActivityRow& row : view.activities) {
    if (row.kind == "cloud") out.sample({{"robot", row.robot}}, number(row.no_valid_point));
  }
  out.gauge("adit_updates_queued", "Queued updates.");
  sample_each(out, view, &ActivityRow::queued);
  out.gauge("adit_updates_accepted_age_seconds", "How long ago the last one was accepted.");
  for (const ActivityRow& row : view.activities) {
    if (!row.last_accepted) continue;
    out.sample({{"kind", row.kind}, {"robot", row.robot}}, seconds_since(*row.last_accepted, view.now));
  }
  out.gauge("adit_updates_forwarded_age_seconds",
            "How long ago the Command Post took the last one that was posted.");
  for (const ActivityRow& row : view.activities) {
    if (row.age) out.sample({{"kind", row.kind}, {"robot", row.robot}}, *row.age);
  }
  out.gauge("adit_updates_received_bytes", "Size of the last one that was accepted.");
  sample_each(out, view, &ActivityRow::bytes_received);
  out.gauge("adit_updates_sent_bytes", "Size of the last one that the Command Post took.");
  sample_each(out, view, &ActivityRow::bytes_sent);
}

void write_refused(Exposition& out, const Usage& usage) {
  out.counter("adit_refused_total", "Messages of the team that Adit refused to their senders.");
  for (const RefusedCount& row : usage.refused) {
    out.sample({{"uri", row.uri}, {"status", std::to_string(row.status)}}, number(row.count));
  }
  out.counter(
      "adit_refused_parts_total",
      "Poses and markers that Adit refused to their senders, each by itself or with all of its message.");
  for (const RefusedCount& row : usage.refused) {
    if (row.parts > 0) out.sample({{"uri", row.uri}}, number(row.parts));
  }
}

}  // namespace

std::string write_metrics(const Measured& measured) {
  Exposition out;
  write_box(out, measured);
  write_alarms(out, measured.view.alarms);
  write_run(out, measured.view);
  write_reports(out, measured.reports);
  write_endpoints(out, measured.view);
  write_link(out, measured);
  write_updates(out, measured.view);
  write_refused(out, measured.usage);
  return out.text();
}

}  // namespace adit::api
