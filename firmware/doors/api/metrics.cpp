#include "api/metrics.hpp"

#include <algorithm>
#include <cmath>

#include "api/verdicts.hpp"
#include "dispatch/report.hpp"
#include "icd/sentence.hpp"

namespace adit::api {
namespace {

/// Escapes backslashes and newlines, and in a label's value quotation marks.
std::string escaped(std::string_view text, bool quoted) {
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '\\' || (quoted && c == '"')) safe += '\\';
    if (c == '\n') {
      safe += "\\n";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string sample_text(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
  return icd::number_text(value);
}

constexpr double kBytesPerMbit = 1e6 / 8;

double number(std::uint64_t value) {
  return static_cast<double>(value);
}

void write_box(Exposition& out, const Measured& measured) {
  const Usage& usage = measured.usage;
  out.gauge("adit_build_info", "Version of the running program; always 1.");
  out.sample({{"version", measured.about.version}, {"build", measured.about.build}}, 1);
  out.gauge("adit_process_start_time_seconds", "Start of the process, in seconds since 1970.");
  out.sample(usage.started);
  out.counter("adit_process_cpu_seconds_total", "Processor time of the process.");
  out.sample(usage.cpu_seconds);
  out.gauge("adit_process_resident_memory_bytes", "Resident memory of the process.");
  out.sample(number(usage.resident_bytes));
  out.gauge("adit_process_open_fds", "Open file descriptors.");
  out.sample(number(usage.open_files));
  out.gauge("adit_process_max_fds", "Limit of open file descriptors.");
  out.sample(number(usage.most_files));
  out.gauge("adit_process_threads", "Threads of the process.");
  out.sample(number(usage.threads));
  out.gauge("adit_connections", "Connections on the team's side.");
  out.sample(number(usage.connections));
  out.gauge("adit_connections_unauthenticated",
            "Connections on the team's side that have shown no token or session.");
  out.sample(number(usage.unauthenticated));
  out.counter("adit_connections_ended_total",
              "Connections that Adit closed: no_room (answered 503), gave_way and idle (closed for another "
              "connection), slow.");
  for (const EndedCount& row : usage.ended) out.sample({{"why", row.why}}, number(row.count));
  out.counter("adit_wrong_tokens_total",
              "Requests with a wrong token, without a required token, or with a token that was not checked "
              "after too many wrong ones.");
  out.sample(number(usage.wrong_tokens));
  out.counter("adit_exceptions_total", "Requests, answers and jobs aborted by an exception.");
  out.sample(number(usage.exceptions));
  out.gauge("adit_sessions", "Open sessions.");
  out.sample({{"role", "operator"}}, number(measured.operators));
  out.sample({{"role", "viewer"}}, number(measured.viewers));
  out.gauge("adit_light", "Each light on the box with its pattern; always 1.");
  for (const LightRow& light : measured.view.lights) {
    out.sample({{"light", light.name}, {"pattern", light.pattern}}, 1);
  }
}

void write_alarms(Exposition& out, const std::vector<alarms::Alarm>& all) {
  out.gauge("adit_alarm", "Active alarms; always 1.");
  for (const alarms::Alarm& alarm : all) {
    out.sample({{"id", alarm.id},
                {"severity", std::string(alarms::kSeverityWords[static_cast<std::size_t>(alarm.severity)])},
                {"side", std::string(alarms::kSideWords[static_cast<std::size_t>(alarm.side)])}},
               1);
  }
  out.gauge("adit_alarms", "Number of active alarms of each severity.");
  for (std::size_t i = 0; i < std::size(alarms::kSeverityWords); ++i) {
    const auto severity = static_cast<alarms::Severity>(i);
    out.sample({{"severity", std::string(alarms::kSeverityWords[i])}},
               number(static_cast<std::size_t>(std::ranges::count(all, severity, &alarms::Alarm::severity))));
  }
}

void write_run(Exposition& out, const RunView& view) {
  out.gauge("adit_run_number", "Adit's number of the run.");
  out.sample(static_cast<double>(view.run_number));
  if (!view.run) return;
  out.gauge("adit_run_info", "The Command Post's names of team and run; always 1.");
  out.sample({{"team", view.run->current_team}, {"run", view.run_id}}, 1);
  out.gauge("adit_run_clock_seconds", "The run's clock; an estimate if the last status is old.");
  out.sample(view.run_clock ? view.run_clock->seconds : view.run->run_clock);
  out.gauge("adit_run_score", "The team's score, from the last status.");
  out.sample(static_cast<double>(view.run->score));
  out.gauge("adit_run_remaining_reports", "Reports left, from the last status.");
  out.sample(static_cast<double>(view.run->remaining_reports));
  if (!view.run_clock) return;
  out.gauge("adit_run_heard_age_seconds", "Age of the run's last status.");
  out.sample(view.run_clock->age);
}

void write_reports(Exposition& out, const ReportCounts& reports) {
  out.gauge("adit_reports", "Artifact reports of all runs, by state.");
  for (std::size_t i = 0; i < reports.in.size(); ++i) {
    out.sample({{"state", std::string(dispatch::kStateWords[i])}}, number(reports.in[i]));
  }
  out.gauge("adit_reports_asking", "Reports in doubt whose outcome Adit is finding out.");
  out.sample(number(reports.asking));
}

void write_endpoints(Exposition& out, const RunView& view) {
  out.gauge("adit_endpoint_up", "1 if there is a connection to the Command Post's endpoint, else 0.");
  for (const EndpointRow& row : view.endpoints) out.sample({{"endpoint", row.name}}, row.connected ? 1 : 0);
  out.gauge("adit_endpoint_answer_seconds", "Duration of the endpoint's last answer.");
  for (const EndpointRow& row : view.endpoints) {
    if (row.answer_ms) out.sample({{"endpoint", row.name}}, *row.answer_ms / 1000);
  }
  out.gauge("adit_endpoint_last_status",
            "HTTP status of the answer to the last request; 0 if there was no answer.");
  for (const EndpointRow& row : view.endpoints) out.sample({{"endpoint", row.name}}, row.last_status);
  out.counter("adit_endpoint_throttled_total", "Answers of the endpoint with status 429.");
  for (const EndpointRow& row : view.endpoints) out.sample({{"endpoint", row.name}}, number(row.throttled));
  out.counter("adit_endpoint_foreign_total",
              "Answers that are not from a Command Post: pages of HTML, redirects.");
  for (const EndpointRow& row : view.endpoints) out.sample({{"endpoint", row.name}}, number(row.foreign));
}

void write_link(Exposition& out, const Measured& measured) {
  out.counter("adit_link_sent_bytes_total", "Bytes of bodies sent to both endpoints.");
  out.sample(number(measured.usage.sent_bytes));
  out.gauge("adit_link_rate_bytes_per_second", "Rate of these bytes over the last seconds.");
  out.sample(measured.view.sent_mbit * kBytesPerMbit);
  out.gauge("adit_link_budget_bytes_per_second", "Limit of that rate; 0 if there is no limit.");
  out.sample(measured.view.budget_mbit * kBytesPerMbit);
  out.gauge("adit_queue_bytes", "Bytes of queued maps.");
  out.sample(number(measured.view.queued_bytes));
  out.gauge("adit_rejected_messages", "Rejected messages that no newer message has replaced.");
  out.sample(number(
      static_cast<std::size_t>(std::ranges::count(measured.view.rejected, false, &RejectedRow::replaced))));
  out.counter("adit_rejected_messages_dropped_total",
              "Rejected messages deleted to make room for newer ones.");
  out.sample(number(measured.usage.rejected_dropped));
}

/// A sample for each robot and kind.
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
  write_counter(out, view, "adit_updates_accepted_total", "Updates accepted from the team.",
                &ActivityRow::accepted);
  write_counter(out, view, "adit_updates_forwarded_total", "Updates delivered to the Command Post.",
                &ActivityRow::forwarded);
  write_counter(out, view, "adit_updates_replaced_total",
                "Updates not sent because a newer update contains all of them.", &ActivityRow::replaced);
  write_counter(out, view, "adit_updates_merged_total", "Updates merged into others.", &ActivityRow::merged);
  write_counter(out, view, "adit_updates_throttled_total", "Answers of 429, each followed by a retry.",
                &ActivityRow::throttled);
  write_counter(out, view, "adit_updates_failed_total", "Tries without an answer, each followed by a retry.",
                &ActivityRow::failed);
  write_counter(out, view, "adit_updates_refused_total", "Updates that the Command Post rejected.",
                &ActivityRow::refused_upstream);
  write_counter(out, view, "adit_updates_no_room_total", "Updates rejected because the queue is full.",
                &ActivityRow::no_room);
  out.gauge("adit_updates_behind_seconds",
            "Time since the oldest undelivered update was accepted; 0 if all are delivered.");
  for (const ActivityRow& row : view.activities) {
    out.sample({{"kind", row.kind}, {"robot", row.robot}}, row.behind.value_or(0));
  }
  out.gauge("adit_updates_arrive", "Whether updates reach the Command Post, in the page's word; always 1.");
  for (const ActivityRow& row : view.activities) {
    out.sample({{"kind", row.kind}, {"robot", row.robot}, {"arrival", std::string(name_of(row.arrival))}}, 1);
  }
  out.gauge("adit_clouds_whole",
            "1 if the robot's newest cloud replaces its queued ones, 0 if each is delivered.");
  for (const ActivityRow& row : view.activities) {
    if (!row.clouds.empty()) out.sample({{"robot", row.robot}}, row.clouds == "whole" ? 1 : 0);
  }
  out.gauge("adit_clouds_rounded_metres",
            "Step to which the coordinates of the last delivered cloud were rounded; 0 if exact.");
  for (const ActivityRow& row : view.activities) {
    if (row.precision.empty()) continue;
    out.sample({{"robot", row.robot}}, row.precision == "1mm" ? 0.001 : row.precision == "8mm" ? 0.008 : 0);
  }
  out.counter("adit_clouds_no_valid_point_total",
              "Clouds accepted but not sent because all of their points are NaN or infinite.");
  for (const ActivityRow& row : view.activities) {
    if (row.kind == "cloud") out.sample({{"robot", row.robot}}, number(row.no_valid_point));
  }
  out.gauge("adit_updates_queued", "Queued updates.");
  sample_each(out, view, &ActivityRow::queued);
  out.gauge("adit_updates_accepted_age_seconds", "Time since the last update was accepted.");
  for (const ActivityRow& row : view.activities) {
    if (!row.last_accepted) continue;
    out.sample({{"kind", row.kind}, {"robot", row.robot}}, seconds_since(*row.last_accepted, view.now));
  }
  out.gauge("adit_updates_forwarded_age_seconds", "Age of the last delivered update.");
  for (const ActivityRow& row : view.activities) {
    if (row.age) out.sample({{"kind", row.kind}, {"robot", row.robot}}, *row.age);
  }
  out.gauge("adit_updates_received_bytes", "Size of the last accepted update.");
  sample_each(out, view, &ActivityRow::bytes_received);
  out.gauge("adit_updates_sent_bytes", "Size of the last delivered update.");
  sample_each(out, view, &ActivityRow::bytes_sent);
}

void write_refused(Exposition& out, const Usage& usage) {
  out.counter("adit_refused_total", "Messages of the team that Adit rejected.");
  for (const RefusedCount& row : usage.refused) {
    out.sample({{"uri", row.uri}, {"status", std::to_string(row.status)}}, number(row.count));
  }
  out.counter("adit_refused_parts_total",
              "Poses and markers that Adit rejected, alone or with their whole message.");
  for (const RefusedCount& row : usage.refused) {
    if (row.parts > 0) out.sample({{"uri", row.uri}}, number(row.parts));
  }
}

}  // namespace

void Exposition::begin(std::string_view name, std::string_view type, std::string_view help) {
  name_ = name;
  text_.append("# HELP ").append(name).append(" ").append(escaped(help, false)).append("\n");
  text_.append("# TYPE ").append(name).append(" ").append(type).append("\n");
}

void Exposition::sample(std::initializer_list<Label> labels, double value) {
  text_ += name_;
  char before = '{';
  for (const auto& [name, text] : labels) {
    text_.append(1, before).append(name).append("=\"").append(escaped(text, true)).append("\"");
    before = ',';
  }
  if (labels.size() > 0) text_ += '}';
  text_.append(" ").append(sample_text(value)).append("\n");
}

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
