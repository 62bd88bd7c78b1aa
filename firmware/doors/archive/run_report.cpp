#include "archive/run_report.hpp"

#include <string.h>  // strverscmp, of glibc

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "archive/html.hpp"
#include "archive/plot.hpp"
#include "icd/in_html.hpp"
#include "icd/sentence.hpp"
#include "icd/utc.hpp"
#include "picture/covered.hpp"

namespace adit::archive {
namespace {

using Curve = std::vector<std::pair<double, std::uint64_t>>;  // covered pixels over time

constexpr const char* kStyle = R"(
@page { size: A4; margin: 15mm; @bottom-right { content: counter(page) " / " counter(pages); font: 8pt sans-serif } }
body { font: 10pt/1.35 Helvetica, Arial, "Liberation Sans", sans-serif; color: #000; background: #fff; max-width: 180mm; margin: 0 auto; print-color-adjust: exact; -webkit-print-color-adjust: exact }
h1 { font-size: 18pt; margin: 0 0 3mm } h2 { font-size: 13pt; margin: 7mm 0 2mm; break-after: avoid }
table { border-collapse: collapse; width: 100%; font-size: 9pt } thead { display: table-header-group; break-inside: avoid }
th, td { text-align: left; vertical-align: top; padding: .7mm 2mm; border-bottom: .3pt solid #777; overflow-wrap: anywhere } th { border-bottom-width: 1pt; overflow-wrap: normal }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap } tr { break-inside: avoid }
.reports { table-layout: fixed } .reports td:last-child { font-size: 8pt } .reports span { white-space: nowrap; font-variant-numeric: tabular-nums }
.reports th:nth-child(1) { width: 9mm } .reports th:nth-child(2) { width: 21mm } .reports th:nth-child(3) { width: 18mm } .reports th:nth-child(4) { width: 34mm } .reports th:nth-child(5) { width: 17mm } .reports th:nth-child(6) { width: 9mm }
dl { display: grid; grid-template-columns: max-content 1fr max-content 1fr; gap: 1mm 4mm; margin: 0 } dt { font-weight: 600 } dd { margin: 0; overflow-wrap: anywhere }
figure { margin: 0; max-width: 100%; break-inside: avoid } .plots { display: flex; flex-wrap: wrap; gap: 3mm 4mm } h2 + .plots, h2 + figure { break-before: avoid }
svg { display: block; width: 100%; font-size: 2.8px } .grid { fill: none; stroke: #000; stroke-opacity: .15; stroke-width: .15 } .axis, .frame { fill: none; stroke: #000; stroke-width: .25 }
.curve { fill: none; stroke: #000; stroke-width: .4; stroke-linejoin: round } .leader { stroke: #000; stroke-width: .2 } .track { fill: none; stroke-width: .5 } .robot { stroke: #fff; stroke-width: .3 }
.scored, .report { stroke: #000; stroke-width: .4 } rect.report, circle.report { fill: #fff } text.scored, text.report { stroke: none; text-anchor: middle; font-size: 2.4px } text.scored { fill: #fff }
.label { stroke: #fff; stroke-width: .7; stroke-linejoin: round; paint-order: stroke }
.legend { list-style: none; margin: 2mm 0 0; padding: 0; columns: 3; column-gap: 6mm; font-size: 9pt } .legend li { break-inside: avoid; padding-left: 11mm; text-indent: -11mm } .legend svg { display: inline-block; width: 8mm; height: 4mm; margin-right: 2mm; vertical-align: -.6mm; overflow: visible; text-indent: 0 }
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

/// "12: 10 answered, 2 held".
std::string counts_of(const std::vector<api::ReportDetail>& reports) {
  std::map<std::string, std::size_t> states;
  for (const api::ReportDetail& report : reports) ++states[report.row.state];
  std::string all;
  for (const auto& [state, count] : states)
    all += icd::sentence(all.empty() ? ": " : ", ", count, " ", state);
  return icd::sentence(reports.size(), all);
}

/// "1234.5 m²"; "at least" if the picture lacks parts of grids.
std::string area_of(std::uint64_t pixels, bool is_whole) {
  const double metres = picture::square_metres(pixels);
  return (is_whole ? "" : "at least ") + fixed(metres, metres < 100 ? 1 : 0) + " m\u00b2";
}

/// If the box does not know the run's start, the first stored time; 0: unknown.
api::Time begin_of(const api::KeptRun& kept, const Curve& curve) {
  if (kept.facts.began > 0) return kept.facts.began;
  if (!kept.history.at.empty()) return kept.history.at.front();
  return curve.empty() ? 0 : curve.front().first;
}

std::string facts_of(const api::KeptRun& kept, const std::vector<api::ReportDetail>& reports,
                     const picture::Covered& covered, api::Time began) {
  const api::RunRow& run = kept.facts;
  return "<dl>\n" + fact("Score", number(run.score)) + fact("Reports left", number(run.remaining_reports)) +
         fact("Reports", counts_of(reports)) +
         fact("Covered area", covered.of.empty() ? "no grid" : area_of(covered.all, covered.is_whole)) +
         fact("Team", run.team) + fact("Course", run.course) + fact("Command Post", run.post) +
         fact("Command Post's name of the run", run.id) + fact("Began (UTC)", icd::utc(began)) +
         fact("Last written (UTC)", icd::utc(run.last)) +
         fact("Lasted", began > 0 ? lasted(run.last - began) : "") + "</dl>\n";
}

/// Times of the day `day` without it.
std::string life_of(const api::ReportDetail& report, const std::string& day) {
  std::string steps;
  for (const api::ReportStep& step : report.history) {
    std::string time = icd::utc(step.at);
    if (time.starts_with(day)) time.erase(0, day.size());
    steps += icd::sentence(steps.empty() ? "<span>" : "; <span>", time, "</span> ", icd::in_html(step.state),
                           step.note.empty() ? "" : ": ", icd::in_html(step.note));
  }
  return "<td>" + steps + "</td>";
}

std::string reports_table(const std::vector<api::ReportDetail>& reports, api::Time began) {
  if (reports.empty()) return "<p>No reports.</p>\n";
  const std::string day = icd::utc(began).substr(0, std::string_view("2026-11-23 ").size());
  std::string rows;
  for (const api::ReportDetail& report : reports) {
    const api::ReportRow& row = report.row;
    rows += "<tr>" + cell(std::to_string(row.number), true) + cell(row.type) + cell(row.robot) +
            cell(place(row.position)) +
            cell(row.asking ? row.state + ", Adit asks for the status" : row.state) +
            cell(signed_change(row.score_change), true) + life_of(report, day) + "</tr>\n";
  }
  return "<table class=\"reports\"><thead><tr><th class=\"n\">No.</th><th>Type</th><th>Robot</th><th>Place "
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
  std::optional<double> oldest;
  for (const auto& age : row->ages) oldest = std::max(oldest, age);
  return oldest ? fixed(*oldest, 0) + " s" : "never there";
}

/// Numbers in names by their value, as on the page: r2 before r10.
struct ByNumber {
  bool operator()(const std::string& one, const std::string& other) const {
    const int difference = strverscmp(one.c_str(), other.c_str());
    return difference != 0 ? difference < 0 : one < other;
  }
};

std::string robots_table(const api::KeptRun& run, const picture::Covered& covered) {
  std::map<std::string, double, ByNumber> metres;
  for (const std::string& robot : run.facts.robots) metres[robot] = 0;
  for (const api::Track& track : run.tracks) metres[track.robot] = length_of(track);
  if (metres.empty()) return "<p>No robot sent a message.</p>\n";
  std::string rows;
  for (const auto& [robot, length] : metres) {
    std::string maps;
    for (const picture::LayerView& layer : run.picture.layers()) {
      if (layer.layer.robot != robot) continue;
      maps +=
          icd::sentence(maps.empty() ? "" : ", ", layer.layer.kind == picture::Kind::Grid ? "grid" : "cloud");
    }
    const auto area = covered.of.find(robot);
    rows += "<tr>" + cell(robot) + cell(fixed(length, 1) + " m", true) + cell(maps) +
            cell(area == covered.of.end() ? "no grid" : area_of(area->second, covered.is_whole), true) +
            cell(oldest_map(run, robot), true) + "</tr>\n";
  }
  return "<table><thead><tr><th>Robot</th><th class=\"n\">Distance</th><th>Maps</th><th class=\"n\">Covered "
         "area</th><th class=\"n\">Oldest map at the Command Post</th></tr></thead><tbody>\n" +
         rows +
         "</tbody></table>\n<p>The covered area is that of the known cells of grids at the Command Post, in "
         "squares of "
         "0.25 m. An area that several robots cover counts once in the whole run.</p>\n";
}

std::string attention_table(const api::KeptRun& run) {
  if (run.history.attention.empty()) return "<p>No alarm needed the operator.</p>\n";
  std::string rows;
  for (const api::AttentionStep& step : run.history.attention)
    rows += "<tr>" + cell(icd::utc(step.at)) + cell(step.came ? "raised" : "cleared") + cell(step.sentence) +
            "</tr>\n";
  return "<table><thead><tr><th>Time (UTC)</th><th>Change</th><th>Alarm</th></tr></thead><tbody>\n" + rows +
         "</tbody></table>\n";
}

std::vector<std::optional<double>> all_known(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

/// The covered area, and the link to the Command Post.
std::string plots(const api::KeptRun& run, const Curve& curve, api::Time began) {
  const auto minutes = [began](api::Time at) { return (at - began) / 60; };
  Plot area{.name = "Covered area (m\u00b2)", .is_held = true};
  for (const auto& [at, pixels] : curve) {
    area.minutes.push_back(minutes(at));
    area.values.emplace_back(picture::square_metres(pixels));
  }
  const api::History& history = run.history;
  constexpr double kHalf = 88, kTall = 45;
  Plot link{.name = "Sent (Mbit/s)", .values = all_known(history.sent_mbit), .width = kHalf, .height = kTall};
  for (const api::Time at : history.at) link.minutes.push_back(minutes(at));
  std::string all = drawn(area) + drawn(link);
  link.name = "Queued maps (MB)";
  for (std::size_t i = 0; i < link.values.size(); ++i)
    link.values[i] = static_cast<double>(history.queued_bytes[i]) / 1e6;
  all += drawn(link);
  link.name = "Answers of scoring (ms)";
  link.values = history.scoring_ms;
  all += drawn(link);
  link.name = "Answers of mapping (ms)";
  link.values = history.mapping_ms;
  all += drawn(link);
  return all.empty() ? "<p>No plot is stored.</p>\n" : "<div class=\"plots\">" + all + "</div>\n";
}

}  // namespace

std::string run_report(const api::KeptRun& run, const std::vector<api::ReportDetail>& reports) {
  const std::string title = icd::in_html(title_of(run.facts));
  picture::CoveredArea area;
  area.update(area.changes(run.picture));
  const picture::Covered covered = area.now();
  const Curve curve = picture::covered_over_time(run.picture);
  const api::Time began = begin_of(run, curve);
  return icd::sentence("<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>", title,
                       "</title><style>", kStyle, "</style></head><body><main>\n<h1>", title, "</h1>\n",
                       facts_of(run, reports, covered, began), "<h2>The map as forwarded</h2>\n",
                       drawn_map(run, reports), "<h2>Robots</h2>\n", robots_table(run, covered),
                       "<h2>Plots</h2>\n", plots(run, curve, began),
                       "<h2>Alarms that needed the operator</h2>\n", attention_table(run),
                       "<h2>Reports</h2>\n", reports_table(reports, began), "</main></body></html>\n");
}

}  // namespace adit::archive
