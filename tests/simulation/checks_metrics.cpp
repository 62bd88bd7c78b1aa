#include "simulation/checks_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "icd/sentence.hpp"

namespace adit::simulation {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kPostDown = "command_post_";

/// The value of a metric with its labels.
std::optional<double> metric(const std::string& text, const std::string& name) {
  const std::size_t at = text.find("\n" + name + " ");
  if (at == std::string::npos) return std::nullopt;
  return std::strtod(text.c_str() + at + name.size() + 2, nullptr);
}

/// Alarms that begin and end by time alone, without an event.
bool goes_by_time(std::string_view id) {
  constexpr std::string_view kByTime[] = {
      "robot_silent",    "robots_silent", "map_behind",   "maps_behind",     "queue_",
      "clients_refused", "wrong_tokens",  "client_token", "unauthenticated", "robot_unknown",
      kPostDown,         "disk_full",     "reports_left"};
  return std::ranges::any_of(kByTime, [&](std::string_view begins) { return id.starts_with(begins); });
}

/// Whether the metrics have an alarm of the Command Post that the view lacks. It began by time alone, and
/// it hides the reports in doubt that Adit is classifying.
bool is_down_since(const Reading& reading) {
  const std::string_view begins = "adit_alarm{id=\"", text = reading.metrics;
  for (std::size_t at = text.find(begins); at != text.npos; at = text.find(begins, at + 1)) {
    const std::string_view id =
        text.substr(at + begins.size(), text.find('"', at + begins.size()) - at - begins.size());
    const auto is_it = [&](const Json& alarm) { return alarm.at("id") == id; };
    if (id.starts_with(kPostDown) && std::ranges::none_of(reading.view.at("alarms"), is_it)) return true;
  }
  return false;
}

/// The metrics name each alarm of the view.
void check_alarms(const Reading& reading, Broken& broken) {
  for (const Json& alarm : reading.view.at("alarms")) {
    const std::string id = alarm.at("id");
    if (goes_by_time(id) || reading.metrics.contains("adit_alarm{id=" + alarm.at("id").dump() + ","))
      continue;
    const bool may_hide = id.starts_with("report_in_doubt") && alarm.at("severity") == "wait";
    if (may_hide && is_down_since(reading)) continue;
    broken.push_back(icd::sentence("Honest: at ", reading.at, " the metrics lack the alarm ", alarm.dump()));
  }
}

}  // namespace

void check_metrics(const Evidence& evidence, const Reading& reading, Broken& broken) {
  if (reading.metrics.empty() || reading.worked) return;
  for (std::size_t i = reading.asked; i < reading.measured; ++i) {
    const Event& event = evidence.events[i];
    const bool ours = event.what == "/adit/run" || event.what == "/metrics";
    if (!ours && event.kind != Kind::Shows && event.kind != Kind::Told) return;
  }
  const auto compare = [&](const std::string& name, double shown) {
    const auto told = metric(reading.metrics, name);
    if (told && std::abs(*told - shown) < 1e-6) return;
    broken.push_back(icd::sentence("Honest: at ", reading.at, " ", name, " is ", told.value_or(-1),
                                   ", but the view has ", shown));
  };
  for (const Json& row : reading.view.at("activities")) {
    const std::string labels = "{kind=" + row.at("kind").dump() + ",robot=" + row.at("robot").dump() + "}";
    for (const char* const count : {"accepted", "forwarded", "replaced", "merged", "throttled", "failed"})
      compare("adit_updates_" + std::string(count) + "_total" + labels, row.at(count));
  }
  check_alarms(reading, broken);
  for (const Json& row : reading.view.at("endpoints")) {
    const std::string labels = "{endpoint=" + row.at("name").dump() + "}";
    compare("adit_endpoint_up" + labels, row.at("connected") ? 1 : 0);
    compare("adit_endpoint_last_status" + labels, row.at("last_status"));
  }
  if (!reading.view.at("run").is_null()) compare("adit_run_score", reading.view.at("run").at("score"));
}

}  // namespace adit::simulation
