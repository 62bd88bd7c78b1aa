// The drawings of a run's report.
#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "archive/html.hpp"
#include "archive/run_report.hpp"
#include "codec/base64.hpp"
#include "icd/in_html.hpp"
#include "icd/sentence.hpp"
#include "icd/utc.hpp"
#include "picture/palette.hpp"
#include "picture/png.hpp"

namespace adit::archive {
namespace {

using picture::kSide;

/// Most bytes of images in a report. Further tiles are left out, and the report says so.
constexpr std::size_t kMostBytes = std::size_t{4} << 20;
constexpr std::size_t kMostTiles = 120;
/// The page's in its light theme (site/files/robot_colour.js).
constexpr const char* kColours[] = {"#9e4930", "#025447", "#6b56a3", "#733200", "#007672",
                                    "#593279", "#7e620d", "#005259", "#844d90", "#524801",
                                    "#0d7287", "#6c2962", "#666c05", "#054f69", "#954674",
                                    "#395105", "#0d6ca5", "#782445", "#3c7630", "#144687"};
/// Lengths of lines and gaps, by the line's width.
constexpr double kDashes[][4] = {{1e6, 0, 1e6, 0}, {4, 2, 4, 2}, {1, 1.5, 1, 1.5}, {4.5, 1.5, 1, 1.5}};

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

std::string image(const picture::Packed& tile, picture::Kind kind, const picture::TileAt& at) {
  const double side = kSide * picture::kMetresPerPixel[static_cast<std::size_t>(at.level)];
  const std::string png = kind == picture::Kind::Grid ? picture::write_png(tile, picture::grid_palette())
                                                      : picture::write_png(tile, picture::cloud_palette());
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(png.data());
  return icd::sentence("<image x=\"", fixed(at.x * side, 2), "\" y=\"", fixed(-(at.y + 1) * side, 2),
                       "\" width=\"", fixed(side, 2), "\" height=\"", fixed(side, 2),
                       "\" image-rendering=\"pixelated\" href=\"data:image/png;base64,",
                       codec::base64_of({bytes, png.size()}), "\"/>\n");
}

/// All layers' tiles of one level, clouds below grids.
std::string tiles_of(const picture::Mosaic& picture, const std::vector<picture::LayerView>& layers,
                     std::size_t& left_out) {
  const int level = level_of(layers);
  std::string all;
  for (const picture::Kind kind : {picture::Kind::Cloud, picture::Kind::Grid}) {
    for (const picture::LayerView& layer : layers) {
      if (layer.layer.kind != kind) continue;
      for (const picture::TileView& tile : layer.tiles) {
        const auto shown = picture.tile(layer.layer, tile.at, {}).tile;
        if (tile.at.level != level || !shown) continue;
        std::string drawn = image(*shown, kind, tile.at);
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

std::string polyline(const api::Track& track, const char* colour, std::span<const double, 4> dashes,
                     double width) {
  std::string points;
  for (const api::TrackPose& pose : track.poses)
    points += fixed(pose.position.x, 2) + ',' + fixed(-pose.position.y, 2) + ' ';
  std::string lengths;
  for (const double length : dashes) lengths += fixed(length * width, 3) + ' ';
  return icd::sentence("<polyline fill=\"none\" stroke=\"", colour, "\" stroke-width=\"", fixed(width, 3),
                       "\" stroke-dasharray=\"", lengths, "\" points=\"", points, "\"><title>",
                       icd::in_html(track.robot), "</title></polyline>\n");
}

/// Without tracks that have no pose.
std::vector<api::Track> by_first_pose(std::vector<api::Track> tracks) {
  std::erase_if(tracks, [](const api::Track& track) { return track.poses.empty(); });
  std::ranges::stable_sort(tracks, {}, [](const api::Track& track) { return track.poses.front().at; });
  return tracks;
}

/// Indices of kColours and kDashes.
struct Look {
  std::size_t colour = 0, dashes = 0;
};

/// As the page's robotLooks(): robots of one chosen colour have different dashes. Other robots have the
/// colours that no robot chose, in the order of `tracks`.
std::vector<Look> looks_of(const std::vector<api::Track>& tracks, const std::vector<api::ColourRow>& chosen) {
  std::vector<Look> looks;
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

/// With a label, so that colour alone does not identify a robot.
std::string marked(double x, double y, const std::string& label, const char* colour, double size) {
  return icd::sentence("<circle cx=\"", fixed(x, 2), "\" cy=\"", fixed(-y, 2), "\" r=\"", fixed(size / 3, 3),
                       "\" fill=\"", colour, "\" stroke=\"#fff\" stroke-width=\"", fixed(size / 15, 3),
                       "\"/><text x=\"", fixed(x + size / 2, 2), "\" y=\"", fixed(-y - size / 2, 2),
                       "\" font-size=\"", fixed(size, 3), "\">", icd::in_html(label), "</text>\n");
}

}  // namespace

std::string drawn_map(const api::KeptRun& run, const std::vector<api::ReportDetail>& reports) {
  const auto layers = run.picture.layers();
  const auto area = area_of(run, layers, reports);
  if (!area) return "<p>No map is stored.</p>\n";
  const double width = std::max(area->right - area->left, 1.0),
               height = std::max(area->top - area->bottom, 1.0);
  const double size = std::max(width, height) / 50, margin = 2 * size;
  std::size_t left_out = 0;
  std::string drawn = tiles_of(run.picture, layers, left_out);
  const auto tracks = by_first_pose(run.tracks);
  const auto looks = looks_of(tracks, run.colours);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const api::Track& track = tracks[i];
    const char* its = kColours[looks[i].colour % std::size(kColours)];
    drawn += polyline(track, its, kDashes[looks[i].dashes % std::size(kDashes)], size / 5);
    const icd::Point& last = track.poses.back().position;
    drawn += marked(last.x, last.y, track.robot, its, size);
  }
  for (const api::ReportDetail& report : reports) {
    if (const auto& at = report.row.position)
      drawn += marked(at->x, at->y, icd::sentence(report.row.number, " ", report.row.type), "#000", size);
  }
  return icd::sentence(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"The map\" viewBox=\"",
      fixed(area->left - margin, 2), " ", fixed(-area->top - margin, 2), " ", fixed(width + 2 * margin, 2),
      " ", fixed(height + 2 * margin, 2), "\">\n", drawn, "</svg>\n<p>", fixed(width, 0), " m by ",
      fixed(height, 0), " m of the frame darpa",
      left_out == 0 ? "" : ", without parts that exceed the size of this report", ".</p>\n");
}

std::string drawn_coverage(const api::KeptRun& run) {
  if (run.coverage.empty()) return "";
  constexpr double kWidth = 600, kHeight = 160;
  const double first = std::min(run.coverage.front().first, run.facts.began > 0 ? run.facts.began : 1e12);
  const double last = std::max(run.coverage.back().first, first + 1);
  double most = 1;
  for (const auto& [at, area] : run.coverage) most = std::max(most, area);
  std::string points = "0," + fixed(kHeight, 0);
  double before = kHeight;
  const std::size_t step = 1 + run.coverage.size() / 2000;
  for (std::size_t i = 0; i < run.coverage.size(); i += step) {
    const auto& [at, area] = run.coverage[i];
    const double x = (at - first) / (last - first) * kWidth, y = kHeight - area / most * kHeight;
    points += icd::sentence(" ", fixed(x, 1), ",", fixed(before, 1), " ", fixed(x, 1), ",", fixed(y, 1));
    before = y;
  }
  return icd::sentence(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"Coverage over time\" "
      "viewBox=\"-4 -4 608 168\"><polyline fill=\"none\" stroke=\"#000\" stroke-width=\"1.5\" points=\"",
      points, "\"/></svg>\n<p>From 0 to ", fixed(most, 0),
      " m\u00b2, the sum over each robot's grids and clouds; from ", icd::utc(first), " to ", icd::utc(last),
      " (UTC).</p>\n");
}

}  // namespace adit::archive
