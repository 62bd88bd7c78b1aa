#include "archive/run_report.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "archive/html.hpp"
#include "icd/in_html.hpp"
#include "icd/sentence.hpp"
#include "icd/utc.hpp"

namespace adit::archive {
namespace {

constexpr const char* kStyle = R"(
@page { size: A4; margin: 15mm }
body { font: 10pt/1.35 system-ui, sans-serif; color: #000; background: #fff; max-width: 180mm; margin: 0 auto }
h1 { font-size: 18pt; margin: 0 0 2mm } h2 { font-size: 13pt; margin: 7mm 0 2mm; break-after: avoid }
table { border-collapse: collapse; width: 100% } caption { text-align: left }
th, td { text-align: left; vertical-align: top; padding: 1mm 2mm; border-bottom: .3pt solid #777 }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums } tr { break-inside: avoid }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 1mm 4mm; margin: 0 } dt { font-weight: 600 } dd { margin: 0 }
svg { width: 100%; max-height: 200mm; border: .3pt solid #777; break-inside: avoid } ol { margin: 0; padding-left: 5mm }
)";

std::string cell(const std::string& text, bool is_number = false) {
  return (is_number ? "<td class=\"n\">" : "<td>") + icd::in_html(text) + "</td>";
}

std::string fact(const char* name, const std::string& value) {
  return value.empty() ? "" : icd::sentence("<dt>", name, "</dt><dd>", icd::in_html(value), "</dd>\n");
}

std::string number(const std::optional<std::int64_t>& value) {
  return value ? std::to_string(*value) : "";
}

/// As in `words.js`.
std::string signed_change(const std::optional<std::int64_t>& change) {
  if (!change) return "";
  return *change > 0 ? '+' + std::to_string(*change) : std::to_string(*change);
}

std::string place(const std::optional<icd::Point>& at) {
  if (!at) return "unknown";
  return fixed(at->x, 2) + ", " + fixed(at->y, 2) + ", " + fixed(at->z, 2);
}

std::string title_of(const api::RunRow& run) {
  return icd::sentence("Run ", run.run, run.course.empty() ? "" : ", course ", run.course);
}

/// If the box does not know the run's start, uses the first stored time.
std::string facts(const api::KeptRun& kept) {
  const api::RunRow& run = kept.facts;
  const double began = run.began > 0 || kept.history.at.empty() ? run.began : kept.history.at.front();
  return "<dl>\n" + fact("Score", number(run.score)) + fact("Reports left", number(run.remaining_reports)) +
         fact("Team", run.team) + fact("Course", run.course) + fact("Command Post", run.post) +
         fact("Command Post's name of the run", run.id) + fact("Began (UTC)", icd::utc(began)) +
         fact("Last written (UTC)", icd::utc(run.last)) +
         fact("Lasted", began > 0 ? lasted(run.last - began) : "") + "</dl>\n";
}

std::string life_of(const api::ReportDetail& report) {
  std::string steps;
  for (const api::ReportStep& step : report.history) {
    steps += icd::sentence("<li>", icd::in_html(icd::utc(step.at)), " ", icd::in_html(step.state),
                           step.note.empty() ? "" : ": ", icd::in_html(step.note), "</li>");
  }
  return "<td><ol>" + steps + "</ol></td>";
}

std::string reports_table(const std::vector<api::ReportDetail>& reports) {
  if (reports.empty()) return "<p>No reports.</p>\n";
  std::string rows;
  for (const api::ReportDetail& report : reports) {
    const api::ReportRow& row = report.row;
    rows += "<tr>" + cell(std::to_string(row.number), true) + cell(row.type) + cell(row.robot) +
            cell(place(row.position)) +
            cell(row.asking ? row.state + ", Adit asks for the status" : row.state) +
            cell(signed_change(row.score_change), true) + life_of(report) + "</tr>\n";
  }
  return "<table><thead><tr><th class=\"n\">No.</th><th>Type</th><th>Robot</th><th>Place "
         "(m)</th><th>State</th><th class=\"n\">Score</th><th>History (UTC)</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n";
}

double length_of(const api::Track& track) {
  double length = 0;
  for (std::size_t i = 1; i < track.poses.size(); ++i) {
    const auto &from = track.poses[i - 1].position, &to = track.poses[i].position;
    length += std::hypot(to.x - from.x, to.y - from.y, to.z - from.z);
  }
  return length;
}

/// The robot's greatest map age at the Command Post.
std::string oldest_map(const api::KeptRun& run, const std::string& robot) {
  const auto row = std::ranges::find(run.history.robots, robot, &api::MapAges::robot);
  if (row == run.history.robots.end()) return "";
  double oldest = 0;
  for (const auto& age : row->ages) oldest = std::max(oldest, age.value_or(0));
  return fixed(oldest, 0) + " s";
}

std::string robots_table(const api::KeptRun& run) {
  std::map<std::string, double> metres;
  for (const std::string& robot : run.facts.robots) metres[robot] = 0;
  for (const api::Track& track : run.tracks) metres[track.robot] = length_of(track);
  if (metres.empty()) return "<p>No robot sent a message.</p>\n";
  std::string rows;
  for (const auto& [robot, length] : metres) {
    std::string maps;
    for (const picture::LayerView& layer : run.picture.layers()) {
      if (layer.layer.robot == robot) maps += layer.layer.kind == picture::Kind::Grid ? "grid " : "cloud ";
    }
    rows += "<tr>" + cell(robot) + cell(fixed(length, 1) + " m", true) + cell(maps) +
            cell(oldest_map(run, robot), true) + "</tr>\n";
  }
  return "<table><thead><tr><th>Robot</th><th class=\"n\">Distance</th><th>Maps</th><th class=\"n\">Oldest "
         "map at the Command Post</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n";
}

std::string attention_table(const api::KeptRun& run) {
  if (run.history.attention.empty()) return "<p>No alarm needed the operator.</p>\n";
  std::string rows;
  for (const api::AttentionStep& step : run.history.attention)
    rows += "<tr>" + cell(icd::utc(step.at)) + cell(step.came ? "raised" : "cleared") + cell(step.sentence) +
            "</tr>\n";
  return "<table><thead><tr><th>Time (UTC)</th><th></th><th>Alarm</th></tr></thead><tbody>\n" + rows +
         "</tbody></table>\n";
}

}  // namespace

std::string run_report(const api::KeptRun& run, const std::vector<api::ReportDetail>& reports) {
  const std::string title = icd::in_html(title_of(run.facts));
  const std::string coverage = drawn_coverage(run);
  return icd::sentence(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>", title, "</title><style>",
      kStyle, "</style></head><body><main>\n<h1>", title, "</h1>\n", facts(run), "<h2>Reports</h2>\n",
      reports_table(reports), "<h2>The map as forwarded</h2>\n", drawn_map(run, reports),
      "<h2>Coverage over time</h2>\n", coverage.empty() ? "<p>No map is stored.</p>\n" : coverage,
      "<h2>Robots</h2>\n", robots_table(run), "<h2>Alarms that needed the operator</h2>\n",
      attention_table(run), "</main></body></html>\n");
}

}  // namespace adit::archive
