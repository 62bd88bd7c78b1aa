#include "archive/run_report.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "archive/plot.hpp"
#include "codec/base64.hpp"
#include "icd/natural_order.hpp"
#include "icd/sentence.hpp"
#include "picture/coverage.hpp"
#include "picture/palette.hpp"

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
  return (is_number ? "<td class=\"n\">" : "<td>") + icd::escape_html(text) + "</td>";
}

std::string fact(const char* name, const std::string& value) {
  return value.empty() ? "" : icd::sentence("<dt>", name, "</dt><dd>", icd::escape_html(value), "</dd>\n");
}

/// `text` of a number with a true minus sign, as on the page.
std::string with_minus(std::string text) {
  return text.starts_with('-') ? "\u2212" + text.substr(1) : text;
}

std::string number(const std::optional<std::int64_t>& value) {
  return value ? with_minus(std::to_string(*value)) : "";
}

/// "+5", "0", "" if unknown.
std::string signed_change(const std::optional<std::int64_t>& change) {
  return (change.value_or(0) > 0 ? "+" : "") + number(change);
}

std::string place(const std::optional<icd::Point>& at) {
  if (!at) return "unknown";
  return with_minus(to_fixed(at->x, 2)) + ", " + with_minus(to_fixed(at->y, 2)) + ", " +
         with_minus(to_fixed(at->z, 2));
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
  return (is_whole ? "" : "at least ") + to_fixed(metres, metres < 100 ? 1 : 0) + " m\u00b2";
}

/// If the box does not know the run's start, the first stored time; 0: unknown.
api::Time begin_of(const api::KeptRun& kept, const Curve& curve) {
  if (kept.facts.began > 0) return kept.facts.began;
  if (!kept.history.at.empty()) return kept.history.at.front();
  return curve.empty() ? 0 : curve.front().first;
}

std::string facts_of(const api::KeptRun& kept, const std::vector<api::ReportDetail>& reports,
                     const picture::Coverage& covered, api::Time began) {
  const api::RunRow& run = kept.facts;
  return "<dl>\n" + fact("Score", number(run.score)) + fact("Reports left", number(run.remaining_reports)) +
         fact("Reports", counts_of(reports)) +
         fact("Covered area", covered.of.empty() ? "no grid" : area_of(covered.all, covered.is_whole)) +
         fact("Team", run.team) + fact("Course", run.course) + fact("Command Post", run.post) +
         fact("Command Post's name of the run", run.id) + fact("Began (UTC)", icd::utc(began)) +
         fact("Last written (UTC)", icd::utc(run.last)) +
         fact("Lasted", began > 0 ? duration_text(run.last - began) : "") + "</dl>\n";
}

/// Times of the day `day` without it.
std::string steps_text(const api::ReportDetail& report, const std::string& day) {
  std::string steps;
  for (const api::ReportStep& step : report.history) {
    std::string time = icd::utc(step.at);
    if (time.starts_with(day)) time.erase(0, day.size());
    steps +=
        icd::sentence(steps.empty() ? "<span>" : "; <span>", time, "</span> ", icd::escape_html(step.state),
                      step.note.empty() ? "" : ": ", icd::escape_html(step.note));
  }
  return "<td>" + steps + "</td>";
}

std::string reports_table(const std::vector<api::ReportDetail>& reports, api::Time began) {
  if (reports.empty()) return "<p>No reports.</p>\n";
  const std::string day = icd::utc(began).substr(0, std::string_view("2026-11-23 ").size());
  std::string rows;
  for (const api::ReportDetail& report : reports) {
    const facts::ReportRow& row = report.row;
    rows += "<tr>" + cell(std::to_string(row.number), true) + cell(row.type) + cell(row.robot) +
            cell(place(row.position)) +
            cell(row.asking ? row.state + ", Adit asks for the status" : row.state) +
            cell(signed_change(row.score_change), true) + steps_text(report, day) + "</tr>\n";
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
  return oldest ? to_fixed(*oldest, 0) + " s" : "never there";
}

std::string robots_table(const api::KeptRun& run, const picture::Coverage& covered) {
  std::map<std::string, double, icd::NaturalOrder> metres;
  for (const std::string& robot : run.facts.robots) metres[robot] = 0;
  for (const api::Track& track : run.tracks) metres[track.robot] = length_of(track);
  if (metres.empty()) return "<p>No robot sent a message.</p>\n";
  std::string rows;
  for (const auto& [robot, length] : metres) {
    std::string maps;
    for (const picture::LayerView& layer : run.picture.layers()) {
      if (layer.layer.robot != robot) continue;
      maps += icd::sentence(maps.empty() ? "" : ", ",
                            layer.layer.kind == picture::LayerKind::Grid ? "grid" : "cloud");
    }
    const auto area = covered.of.find(robot);
    rows += "<tr>" + cell(robot) + cell(to_fixed(length, 1) + " m", true) + cell(maps) +
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

std::vector<std::optional<double>> to_optionals(const std::vector<double>& values) {
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
  Plot link{
      .name = "Sent (Mbit/s)", .values = to_optionals(history.sent_mbit), .width = kHalf, .height = kTall};
  for (const api::Time at : history.at) link.minutes.push_back(minutes(at));
  std::string all = draw_plot(area) + draw_plot(link);
  link.name = "Queued maps (MB)";
  for (std::size_t i = 0; i < link.values.size(); ++i)
    link.values[i] = static_cast<double>(history.queued_bytes[i]) / 1e6;
  all += draw_plot(link);
  link.name = "Answers of scoring (ms)";
  link.values = history.scoring_ms;
  all += draw_plot(link);
  link.name = "Answers of mapping (ms)";
  link.values = history.mapping_ms;
  all += draw_plot(link);
  return all.empty() ? "<p>No plot is stored.</p>\n" : "<div class=\"plots\">" + all + "</div>\n";
}

}  // namespace

std::string run_report(const api::KeptRun& run, const std::vector<api::ReportDetail>& reports) {
  const std::string title = icd::escape_html(title_of(run.facts));
  picture::CoveredArea area;
  area.update(area.changes(run.picture));
  const picture::Coverage covered = area.now();
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

namespace {

/// Most bytes of images in a report. Further tiles are left out, and the report says so.
constexpr std::size_t kMostBytes = std::size_t{4} << 20;
constexpr std::size_t kMostTiles = 120;
/// The page's in its light theme (site/files/robot_colour.js). tests/page/robot_colour.test.js compares them.
constexpr const char* kColours[] = {
    "#9e4930", "#025447", "#6b56a3", "#733200", "#007672", "#593279", "#7e620d", "#005259",
    "#844d90", "#524801", "#0d7287", "#6c2962", "#666c05", "#054f69", "#954674", "#395105",
    "#0d6ca5", "#782445", "#3c7630", "#144687", "#9d4b26", "#06534c", "#7254a0", "#6c3805",
    "#117476", "#5e3074", "#79640e", "#01515c", "#894b8a", "#4d4a05", "#07718d", "#6f285c",
    "#5d6f04", "#004e71", "#99456c", "#2d5402", "#2569a8", "#79243d", "#02785e", "#244387"};
/// Lengths of lines and gaps in millimetres, as patterns of these colours: the page's, of 0.3 mm a unit.
constexpr const char* kDashes[] = {"none", "2.4 1.2", "0.6 0.9", "2.7 0.9 0.6 0.9"};
/// In millimetres: of the map's frame and around it, of text, and of signs.
constexpr double kWidth = 180, kLeft = 12, kTop = 2, kRight = 3, kBottom = 10;
constexpr double kLeastHeight = 50, kMostHeight = 150, kFont = 2.8, kRobot = 1.3, kReport = 1.2, kGroup = 2.4;
constexpr std::size_t kMostCharacters = 24;  // of a label

/// The finest level without too many tiles.
int level_of(const std::vector<picture::LayerView>& layers) {
  for (int level = 0; level + 1 < picture::kLevels; ++level) {
    std::size_t tiles = 0;
    for (const picture::LayerView& layer : layers)
      tiles += static_cast<std::size_t>(std::ranges::count(
          layer.tiles, level, [](const picture::TileView& tile) { return tile.at.level; }));
    if (tiles <= kMostTiles) return level;
  }
  return picture::kLevels - 1;
}

/// The drawn part of the frame "darpa", and its place on paper.
struct Sheet {
  picture::Area area;
  Box frame;
  double scale = 1;  // millimetres for a metre

  double x(double metres) const { return frame.left + (metres - area.left) * scale; }
  double y(double metres) const { return frame.bottom - (metres - area.bottom) * scale; }
};

/// `shown` with a margin, extended to fill the width of the paper and the least height.
Sheet sheet_of(const picture::Area& shown) {
  constexpr double kAcross = kWidth - kLeft - kRight, kMargin = 1.08, kLeast = 4;
  const double width = std::max((shown.right - shown.left) * kMargin, kLeast),
               height = std::max((shown.top - shown.bottom) * kMargin, kLeast);
  Sheet sheet{.area = {}, .frame = {}, .scale = std::min(kAcross / width, kMostHeight / height)};
  const double tall = std::max(height * sheet.scale, kLeastHeight);
  sheet.frame = {kLeft, kTop, kLeft + kAcross, kTop + tall};
  const double x = (shown.left + shown.right) / 2, y = (shown.bottom + shown.top) / 2;
  const double across = kAcross / sheet.scale / 2, up = tall / sheet.scale / 2;
  sheet.area = {x - across, y - up, x + across, y + up};
  return sheet;
}

std::string image(const picture::PackedTile& tile, picture::LayerKind kind, const picture::TileIndex& at,
                  const Sheet& sheet) {
  const picture::Area area = picture::area_of(at);
  const std::string png = kind == picture::LayerKind::Grid
                              ? picture::write_png(tile, picture::grid_palette())
                              : picture::write_png(tile, picture::cloud_palette());
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(png.data());
  const std::string side = to_fixed((area.right - area.left) * sheet.scale, 3);
  return icd::sentence("<image x=\"", to_fixed(sheet.x(area.left), 3), "\" y=\"",
                       to_fixed(sheet.y(area.top), 3), "\" width=\"", side, "\" height=\"", side,
                       "\" image-rendering=\"pixelated\" href=\"data:image/png;base64,",
                       codec::base64_of({bytes, png.size()}), "\"/>\n");
}

/// All layers' tiles of one level, clouds below grids.
std::string tiles_of(const picture::Mosaic& picture, const std::vector<picture::LayerView>& layers,
                     const Sheet& sheet, std::size_t& left_out) {
  const int level = level_of(layers);
  std::string all;
  for (const picture::LayerKind kind : {picture::LayerKind::Cloud, picture::LayerKind::Grid}) {
    for (const picture::LayerView& layer : layers) {
      if (layer.layer.kind != kind) continue;
      for (const picture::TileView& tile : layer.tiles) {
        const auto shown = picture.tile(layer.layer, tile.at, {}).tile;
        if (tile.at.level != level || !shown) continue;
        std::string drawn = image(*shown, kind, tile.at, sheet);
        if (all.size() + drawn.size() > kMostBytes) {
          ++left_out;
          continue;
        }
        all += drawn;
      }
    }
  }
  return all;
}

void extend(std::optional<picture::Area>& area, double x, double y) {
  constexpr double kMost = picture::kWorldMetres;
  if (std::abs(x) < kMost && std::abs(y) < kMost) picture::extend(area, {x, y, x, y});
}

std::optional<picture::Area> area_of(const api::KeptRun& run, const std::vector<picture::LayerView>& layers,
                                     const std::vector<api::ReportDetail>& reports) {
  std::optional<picture::Area> area;
  for (const picture::LayerView& layer : layers) {
    if (layer.bounds) picture::extend(area, *layer.bounds);
  }
  for (const api::Track& track : run.tracks) {
    for (const api::TrackPose& pose : track.poses) extend(area, pose.position.x, pose.position.y);
  }
  for (const api::ReportDetail& report : reports) {
    if (report.row.position) extend(area, report.row.position->x, report.row.position->y);
  }
  return area;
}

/// Figures and lines in metres at the frame's lower and left edge.
std::string axes(const Sheet& sheet) {
  constexpr double kBetween = 18;  // about, in millimetres
  const auto& [left, top, right, bottom] = sheet.frame;
  std::string lines, figures;
  const auto columns = ticks(sheet.area.left, sheet.area.right, static_cast<int>((right - left) / kBetween));
  const auto rows = ticks(sheet.area.bottom, sheet.area.top, static_cast<int>((bottom - top) / kBetween));
  for (const double x : columns) {
    const std::string at = to_fixed(sheet.x(x), 2);
    lines += icd::sentence("M", at, " ", to_fixed(top, 2), "V", to_fixed(bottom, 2));
    figures +=
        icd::sentence("<text x=\"", at, "\" y=\"", to_fixed(bottom + 4, 2), "\" text-anchor=\"middle\">",
                      with_minus(to_fixed(x, decimals_of(columns))), "</text>");
  }
  for (const double y : rows) {
    lines += icd::sentence("M", to_fixed(left, 2), " ", to_fixed(sheet.y(y), 2), "H", to_fixed(right, 2));
    figures +=
        icd::sentence("<text x=\"", to_fixed(left - 1, 2), "\" y=\"", to_fixed(sheet.y(y) + 1, 2),
                      "\" text-anchor=\"end\">", with_minus(to_fixed(y, decimals_of(rows))), "</text>");
  }
  return icd::sentence("<path class=\"grid\" d=\"", lines, "\"/>", figures, "<text x=\"", to_fixed(right, 2),
                       "\" y=\"", to_fixed(bottom + 8, 2),
                       "\" text-anchor=\"end\">x and y in metres, frame darpa</text>\n");
}

/// Indices of kColours and kDashes.
struct LineStyle {
  std::size_t colour = 0, dashes = 0;
};

const char* colour_of(const LineStyle& look) {
  return kColours[look.colour % std::size(kColours)];
}

/// A robot's line: along a track, and in the legend.
std::string stroke_of(const LineStyle& look) {
  return icd::sentence("class=\"track\" stroke=\"", colour_of(look), "\" stroke-dasharray=\"",
                       kDashes[look.dashes % std::size(kDashes)], "\"");
}

std::string polyline(const api::Track& track, const LineStyle& look, const Sheet& sheet) {
  std::string points;
  for (const api::TrackPose& pose : track.poses)
    points += to_fixed(sheet.x(pose.position.x), 2) + ',' + to_fixed(sheet.y(pose.position.y), 2) + ' ';
  return icd::sentence("<polyline ", stroke_of(look), " points=\"", points, "\"><title>",
                       icd::escape_html(track.robot), "</title></polyline>\n");
}

/// Without tracks that have no pose.
std::vector<api::Track> sort_by_first_pose(std::vector<api::Track> tracks) {
  std::erase_if(tracks, [](const api::Track& track) { return track.poses.empty(); });
  std::ranges::stable_sort(tracks, {}, [](const api::Track& track) { return track.poses.front().at; });
  return tracks;
}

/// As the page's robotLooks(): robots of one chosen colour have different dashes. Other robots have the
/// colours that no robot chose, in the order of `tracks`.
std::vector<LineStyle> line_styles(const std::vector<api::Track>& tracks,
                                   const std::vector<api::ColourRow>& chosen) {
  std::vector<LineStyle> looks;
  std::map<std::size_t, std::size_t> robots;  // by chosen colour
  std::size_t next = 0;
  for (const api::Track& track : tracks) {
    const auto own = std::ranges::find(chosen, track.robot, &api::ColourRow::name);
    if (own != chosen.end()) {
      const auto colour = static_cast<std::size_t>(own->colour - 1);
      looks.push_back({colour, colour + robots[colour]++});
    } else {
      while (std::ranges::count(chosen, static_cast<int>(next + 1), &api::ColourRow::colour) > 0) ++next;
      looks.push_back({next, next});
      ++next;
    }
  }
  return looks;
}

/// Reports that would cover each other, as one sign at the first one's place.
struct Sign {
  double x = 0, y = 0;
  std::vector<const api::ReportDetail*> reports;

  bool has_scored() const {
    return std::ranges::any_of(reports,
                               [](const auto* each) { return each->row.score_change.value_or(0) > 0; });
  }
  double radius() const { return reports.size() > 1 ? kGroup : kReport; }
  Box box() const { return {x - radius(), y - radius(), x + radius(), y + radius()}; }
};

std::vector<Sign> signs_of(const std::vector<api::ReportDetail>& reports, const Sheet& sheet) {
  std::vector<Sign> signs;
  for (const api::ReportDetail& report : reports) {
    if (!report.row.position) continue;
    const double x = sheet.x(report.row.position->x), y = sheet.y(report.row.position->y);
    if (!sheet.frame.contains({x, y, x, y})) continue;  // outside the world
    const auto near = std::ranges::find_if(signs, [&](const Sign& sign) {
      return std::max(std::abs(sign.x - x), std::abs(sign.y - y)) < 2 * kGroup;
    });
    (near == signs.end() ? signs.emplace_back(x, y) : *near).reports.push_back(&report);
  }
  return signs;
}

/// A disk for a group with its number, a square for one report: filled if one of them scored.
std::string draw_sign(const Sign& sign) {
  std::string title, shape;
  for (const api::ReportDetail* each : sign.reports)
    title += icd::sentence(title.empty() ? "" : ", ", each->row.number, " ", each->row.type);
  const char* kind = sign.has_scored() ? "scored" : "report";
  if (sign.reports.size() == 1) {
    shape = icd::sentence("<rect class=\"", kind, "\" x=\"", to_fixed(sign.x - kReport, 2), "\" y=\"",
                          to_fixed(sign.y - kReport, 2), "\" width=\"", to_fixed(2 * kReport, 1),
                          "\" height=\"", to_fixed(2 * kReport, 1), "\"/>");
  } else {
    shape = icd::sentence("<circle class=\"", kind, "\" cx=\"", to_fixed(sign.x, 2), "\" cy=\"",
                          to_fixed(sign.y, 2), "\" r=\"", to_fixed(kGroup, 1), "\"/><text class=\"", kind,
                          "\" x=\"", to_fixed(sign.x, 2), "\" y=\"", to_fixed(sign.y + 0.8, 2), "\">",
                          sign.reports.size(), "</text>");
  }
  return icd::sentence("<g><title>", icd::escape_html(title), "</title>", shape, "</g>\n");
}

/// The first of `texts` that has room beside the sign; "" if none has. A line leads to a label farther away.
std::string label(Labels& labels, double x, double y, double radius, const std::vector<std::string>& texts) {
  for (const std::string& each : texts) {
    const std::string text = shorten(each, kMostCharacters);
    const auto box = labels.place(x, y, radius, width_of(text, kFont), kFont * 1.2);
    if (!box) continue;
    const double to_x = std::clamp(x, box->left, box->right), to_y = std::clamp(y, box->top, box->bottom);
    const bool is_far = std::hypot(to_x - x, to_y - y) > radius + 1.5;
    const bool is_right = box->left > x, is_left = box->right < x;
    return icd::sentence(
        is_far ? icd::sentence("<path class=\"leader\" d=\"M", to_fixed(x, 2), " ", to_fixed(y, 2), "L",
                               to_fixed(to_x, 2), " ", to_fixed(to_y, 2), "\"/>")
               : "",
        "<text class=\"label\" text-anchor=\"",
        is_right  ? "start"
        : is_left ? "end"
                  : "middle",
        "\" x=\"",
        to_fixed(is_right  ? box->left
                 : is_left ? box->right
                           : (box->left + box->right) / 2,
                 2),
        "\" y=\"", to_fixed(box->bottom - kFont * 0.32, 2), "\">", icd::escape_html(text), "</text>\n");
  }
  return "";
}

std::string swatch(const std::string& drawn, const std::string& meaning) {
  return icd::sentence("<li><svg viewBox=\"0 0 8 4\" aria-hidden=\"true\">", drawn, "</svg> ",
                       icd::escape_html(meaning), "</li>");
}

std::string colour_swatch(const picture::Colour& colour, const std::string& meaning) {
  return swatch(icd::sentence("<rect width=\"8\" height=\"4\" fill=\"rgb(", colour.red, " ", colour.green,
                              " ", colour.blue, ")\"/>"),
                meaning);
}

std::string legend(const std::vector<api::Track>& tracks, const std::vector<LineStyle>& looks,
                   const std::vector<picture::LayerView>& layers, const std::vector<Sign>& signs) {
  std::string all;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    all += swatch(icd::sentence("<path ", stroke_of(looks[i]),
                                " d=\"M0 2H8\"/><circle class=\"robot\" cx=\"6\" cy=\"2\" r=\"",
                                to_fixed(kRobot, 1), "\" fill=\"", colour_of(looks[i]), "\"/>"),
                  shorten(tracks[i].robot, kMostCharacters));
  }
  const auto has = [&](picture::LayerKind kind) {
    return std::ranges::any_of(layers,
                               [&](const auto& each) { return each.layer.kind == kind && each.bounds; });
  };
  if (has(picture::LayerKind::Grid)) {
    all += colour_swatch(picture::grid_palette()[1], "grid: free");
    all += colour_swatch(picture::grid_palette()[picture::kMostOccupiedIndex], "grid: occupied");
  }
  if (has(picture::LayerKind::Cloud)) {
    all +=
        colour_swatch(picture::height_ramp().front(),
                      icd::sentence("cloud: at or below ", with_minus(to_fixed(picture::kLowest, 0)), " m"));
    all += colour_swatch(picture::height_ramp().back(),
                         icd::sentence("cloud: at or above ", picture::kHighest, " m"));
  }
  if (!signs.empty()) {
    all += swatch("<rect class=\"scored\" x=\"2.8\" y=\"0.8\" width=\"2.4\" height=\"2.4\"/>",
                  "report that scored");
    all +=
        swatch("<rect class=\"report\" x=\"2.8\" y=\"0.8\" width=\"2.4\" height=\"2.4\"/>", "another report");
    all += swatch(
        "<circle class=\"report\" cx=\"4\" cy=\"2\" r=\"1.8\"/><text class=\"report\" x=\"4\" "
        "y=\"2.8\">9</text>",
        "reports at one place; filled: one of them scored");
  }
  return all.empty() ? "" : "<ul class=\"legend\">" + all + "</ul>\n";
}

}  // namespace

std::string drawn_map(const api::KeptRun& run, const std::vector<api::ReportDetail>& reports) {
  const auto layers = run.picture.layers();
  const auto area = area_of(run, layers, reports);
  if (!area) return "<p>No map, track or place of a report is stored.</p>\n";
  const Sheet sheet = sheet_of(*area);
  const auto tracks = sort_by_first_pose(run.tracks);
  const auto looks = line_styles(tracks, run.colours);
  const auto signs = signs_of(reports, sheet);
  std::size_t left_out = 0;
  std::string drawn_there = tiles_of(run.picture, layers, sheet, left_out), lines, robots, names, marks;
  Labels labels{sheet.frame};
  for (const Sign& sign : signs) labels.keep_free(sign.box());
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const icd::Point& last = tracks[i].poses.back().position;
    const double x = sheet.x(last.x), y = sheet.y(last.y);
    labels.keep_free({x - kRobot, y - kRobot, x + kRobot, y + kRobot});
    lines += polyline(tracks[i], looks[i], sheet);
    robots += icd::sentence("<circle class=\"robot\" cx=\"", to_fixed(x, 2), "\" cy=\"", to_fixed(y, 2),
                            "\" r=\"", to_fixed(kRobot, 1), "\" fill=\"", colour_of(looks[i]), "\"/>\n");
  }
  for (const api::Track& track : tracks) {
    const icd::Point& last = track.poses.back().position;
    names += label(labels, sheet.x(last.x), sheet.y(last.y), kRobot, {track.robot});
  }
  for (const Sign& sign : signs) {
    marks += draw_sign(sign);
    const facts::ReportRow& row = sign.reports.front()->row;
    const std::string number = std::to_string(row.number);
    if (sign.reports.size() == 1)
      names += label(labels, sign.x, sign.y, kReport, {number + " " + row.type, number});
  }
  const std::string inside = icd::sentence("x=\"", to_fixed(kLeft, 1), "\" y=\"", to_fixed(kTop, 1),
                                           "\" width=\"", to_fixed(sheet.frame.right - kLeft, 2),
                                           "\" height=\"", to_fixed(sheet.frame.bottom - kTop, 2), "\"");
  return icd::sentence(
      "<figure><svg role=\"img\" aria-label=\"The map\" viewBox=\"0 0 ", to_fixed(kWidth, 0), " ",
      to_fixed(sheet.frame.bottom + kBottom, 2), "\"><clipPath id=\"frame\"><rect ", inside,
      "/></clipPath>\n<g clip-path=\"url(#frame)\">", drawn_there, "</g>\n", axes(sheet),
      "<g clip-path=\"url(#frame)\">", lines, "</g>\n", names, robots, marks, "<rect class=\"frame\" ",
      inside, "/></svg>\n", legend(tracks, looks, layers, signs),
      left_out == 0 ? "" : "<p>The map lacks parts that exceed the size of this report.</p>\n",
      "</figure>\n");
}

}  // namespace adit::archive
