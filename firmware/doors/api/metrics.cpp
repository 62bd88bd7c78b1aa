#include "api/metrics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "dispatch/report.hpp"
#include "icd/sentence.hpp"

namespace adit::api {
namespace {

/// Escapes backslashes and newlines, and in a label's value quotation marks.
std::string escape_label(std::string_view text, bool quoted) {
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

using Label = Exposition::Label;

constexpr double kBytesPerMbit = 1e6 / 8;

/// A metric with a sample for each row, except for std::nullopt. `value`: a member or a function of the row.
void add_rows(Exposition& out, std::string_view name, std::string_view help, const auto& rows, auto labels_of,
              auto value) {
  out.begin(name, help);
  for (const auto& row : rows) {
    const auto sampled = std::invoke(value, row);
    if constexpr (requires { sampled.has_value(); }) {
      if (sampled) out.sample(labels_of(row), *sampled);
    } else {
      out.sample(labels_of(row), static_cast<double>(sampled));
    }
  }
}

void write_box(Exposition& out, const MetricsInput& measured) {
  const Usage& usage = measured.usage;
  out.begin("adit_build_info", "Version of the running program; always 1.");
  out.sample({{"version", measured.about.version}, {"build", measured.about.build}}, 1);
  out.add("adit_process_start_time_seconds", "Start of the process, in seconds since 1970.", usage.started);
  out.add("adit_process_cpu_seconds_total", "Processor time of the process.", usage.cpu_seconds);
  out.add("adit_process_resident_memory_bytes", "Resident memory of the process.", usage.resident_bytes);
  out.add("adit_process_open_fds", "Open file descriptors.", usage.open_files);
  out.add("adit_process_max_fds", "Limit of open file descriptors.", usage.most_files);
  out.add("adit_process_threads", "Threads of the process.", usage.threads);
  out.add("adit_connections", "Connections on the team's side.", usage.connections);
  out.add("adit_connections_unauthenticated",
          "Connections on the team's side that have shown no token or session.", usage.unauthenticated);
  out.begin("adit_connections_ended_total",
            "Connections that Adit closed: no_room (answered 503), gave_way and idle (closed for another "
            "connection), slow.");
  for (const EndedCount& row : usage.ended) out.sample({{"why", row.why}}, row.count);
  out.add("adit_wrong_tokens_total",
          "Requests with a wrong token, without a required token, or with a token that was not checked "
          "after too many wrong ones.",
          usage.wrong_tokens);
  out.add("adit_exceptions_total", "Requests, answers and jobs aborted by an exception.", usage.exceptions);
  out.begin("adit_sessions", "Open sessions.");
  out.sample({{"role", "operator"}}, measured.operators);
  out.sample({{"role", "viewer"}}, measured.viewers);
  out.begin("adit_light", "Each light on the box with its pattern; always 1.");
  for (const LightRow& light : measured.view.lights)
    out.sample({{"light", light.name}, {"pattern", light.pattern}}, 1);
}

void write_alarms(Exposition& out, const std::vector<alarms::Alarm>& all) {
  out.begin("adit_alarm", "Active alarms; always 1.");
  for (const alarms::Alarm& alarm : all) {
    out.sample({{"id", alarm.id},
                {"severity", alarms::kSeverityWords[static_cast<std::size_t>(alarm.severity)]},
                {"side", alarms::kSideWords[static_cast<std::size_t>(alarm.side)]}},
               1);
  }
  out.begin("adit_alarms", "Number of active alarms of each severity.");
  for (std::size_t i = 0; i < std::size(alarms::kSeverityWords); ++i) {
    const auto severity = static_cast<alarms::Severity>(i);
    out.sample({{"severity", alarms::kSeverityWords[i]}},
               std::ranges::count(all, severity, &alarms::Alarm::severity));
  }
}

void write_run(Exposition& out, const RunView& view) {
  out.add("adit_run_number", "Adit's number of the run.", view.run_number);
  if (!view.run) return;
  out.begin("adit_run_info", "The Command Post's names of team and run; always 1.");
  out.sample({{"team", view.run->current_team}, {"run", view.run_id}}, 1);
  out.add("adit_run_clock_seconds", "The run's clock; an estimate if the last status is old.",
          view.run_clock ? view.run_clock->seconds : view.run->run_clock);
  out.add("adit_run_score", "The team's score, from the last status.", view.run->score);
  out.add("adit_run_remaining_reports", "Reports left, from the last status.", view.run->remaining_reports);
  if (view.run_clock)
    out.add("adit_run_heard_age_seconds", "Age of the run's last status.", view.run_clock->age);
}

void write_reports(Exposition& out, const ReportCounts& reports) {
  out.begin("adit_reports", "Artifact reports of all runs, by state.");
  for (std::size_t i = 0; i < reports.in.size(); ++i)
    out.sample({{"state", dispatch::kStateWords[i]}}, reports.in[i]);
  out.add("adit_reports_asking", "Reports in doubt whose outcome Adit is finding out.", reports.asking);
}

void write_endpoints(Exposition& out, const RunView& view) {
  const auto add = [&](std::string_view name, std::string_view help, auto value) {
    const auto labels_of = [](const facts::EndpointRow& row) {
      return std::array{Label{"endpoint", row.name}};
    };
    add_rows(out, name, help, view.endpoints, labels_of, value);
  };
  add("adit_endpoint_up", "1 if there is a connection to the Command Post's endpoint, else 0.",
      &facts::EndpointRow::connected);
  add("adit_endpoint_answer_seconds", "Duration of the endpoint's last answer.",
      [](const facts::EndpointRow& row) {
        return row.answer_ms.transform([](double ms) { return ms / 1000; });
      });
  add("adit_endpoint_last_status", "HTTP status of the answer to the last request; 0 if there was no answer.",
      &facts::EndpointRow::last_status);
  add("adit_endpoint_throttled_total", "Answers of the endpoint with status 429.",
      &facts::EndpointRow::throttled);
  add("adit_endpoint_foreign_total", "Answers that are not from a Command Post: pages of HTML, redirects.",
      &facts::EndpointRow::foreign);
}

void write_link(Exposition& out, const MetricsInput& measured) {
  const RunView& view = measured.view;
  out.add("adit_link_sent_bytes_total", "Bytes of bodies sent to both endpoints.", measured.usage.sent_bytes);
  out.add("adit_link_rate_bytes_per_second", "Rate of these bytes over the last seconds.",
          view.sent_mbit * kBytesPerMbit);
  out.add("adit_link_budget_bytes_per_second", "Limit of that rate; 0 if there is no limit.",
          view.budget_mbit * kBytesPerMbit);
  out.add("adit_queue_bytes", "Bytes of queued maps.", view.queued_bytes);
  out.add("adit_rejected_messages", "Rejected messages that no newer message has replaced.",
          std::ranges::count(view.rejected, false, &facts::RejectedRow::replaced));
  out.add("adit_rejected_messages_dropped_total", "Rejected messages deleted to make room for newer ones.",
          measured.usage.rejected_dropped);
}

void write_updates(Exposition& out, const RunView& view) {
  const auto add = [&](std::string_view name, std::string_view help, auto value) {
    const auto labels_of = [](const facts::ActivityRow& row) {
      return std::array{Label{"kind", row.kind}, Label{"robot", row.robot}};
    };
    add_rows(out, name, help, view.activities, labels_of, value);
  };
  add("adit_updates_accepted_total", "Updates accepted from the team.", &facts::ActivityRow::accepted);
  add("adit_updates_forwarded_total", "Updates delivered to the Command Post.",
      &facts::ActivityRow::forwarded);
  add("adit_updates_replaced_total", "Updates not sent because a newer update contains all of them.",
      &facts::ActivityRow::replaced);
  add("adit_updates_merged_total", "Updates merged into others.", &facts::ActivityRow::merged);
  add("adit_updates_throttled_total", "Answers of 429, each followed by a retry.",
      &facts::ActivityRow::throttled);
  add("adit_updates_failed_total", "Tries without an answer, each followed by a retry.",
      &facts::ActivityRow::failed);
  add("adit_updates_refused_total", "Updates that the Command Post rejected.",
      &facts::ActivityRow::refused_upstream);
  add("adit_updates_no_room_total", "Updates rejected because the queue is full.",
      &facts::ActivityRow::no_room);
  add("adit_updates_age_seconds",
      "Time since the oldest undelivered update was accepted; 0 if all are delivered.",
      [](const facts::ActivityRow& row) { return row.age.value_or(0); });
  out.begin("adit_updates_arrive", "Whether updates reach the Command Post, in the page's word; always 1.");
  for (const facts::ActivityRow& row : view.activities)
    out.sample({{"kind", row.kind}, {"robot", row.robot}, {"arrival", name_of(row.arrival)}}, 1);
  out.begin("adit_clouds_whole",
            "1 if the robot's newest cloud replaces its queued ones, 0 if each is delivered.");
  for (const facts::ActivityRow& row : view.activities) {
    if (!row.clouds.empty()) out.sample({{"robot", row.robot}}, row.clouds == "whole");
  }
  out.begin("adit_clouds_rounded_metres",
            "Step to which the coordinates of the last delivered cloud were rounded; 0 if exact.");
  for (const facts::ActivityRow& row : view.activities) {
    if (row.precision.empty()) continue;
    out.sample({{"robot", row.robot}}, row.precision == "1mm" ? 0.001 : row.precision == "8mm" ? 0.008 : 0);
  }
  out.begin("adit_clouds_no_valid_point_total",
            "Clouds accepted but not sent because all of their points are NaN or infinite.");
  for (const facts::ActivityRow& row : view.activities) {
    if (row.kind == "cloud") out.sample({{"robot", row.robot}}, row.no_valid_point);
  }
  add("adit_updates_queued", "Queued updates.", &facts::ActivityRow::queued);
  add("adit_updates_heard_seconds", "Time since the last update was accepted.", &facts::ActivityRow::heard);
  add("adit_updates_received_bytes", "Size of the last accepted update.",
      &facts::ActivityRow::bytes_received);
  add("adit_updates_sent_bytes", "Size of the last delivered update.", &facts::ActivityRow::bytes_sent);
}

void write_refused(Exposition& out, const Usage& usage) {
  out.begin("adit_refused_total", "Messages of the team that Adit rejected.");
  for (const RefusedCount& row : usage.refused)
    out.sample({{"uri", row.uri}, {"status", std::to_string(row.status)}}, row.count);
  out.begin("adit_refused_parts_total",
            "Poses and markers that Adit rejected, alone or with their whole message.");
  for (const RefusedCount& row : usage.refused) {
    if (row.parts > 0) out.sample({{"uri", row.uri}}, row.parts);
  }
}

}  // namespace

void Exposition::begin(std::string_view name, std::string_view help) {
  name_ = name;
  const std::string_view type = name.ends_with("_total") ? "counter" : "gauge";
  text_.append("# HELP ").append(name).append(" ").append(escape_label(help, false)).append("\n");
  text_.append("# TYPE ").append(name).append(" ").append(type).append("\n");
}

void Exposition::write_sample(std::span<const Label> labels, double value) {
  text_ += name_;
  char before = '{';
  for (const auto& [name, text] : labels) {
    text_.append(1, before).append(name).append("=\"").append(escape_label(text, true)).append("\"");
    before = ',';
  }
  if (!labels.empty()) text_ += '}';
  text_.append(" ").append(sample_text(value)).append("\n");
}

std::string write_metrics(const MetricsInput& measured) {
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
