#include "api/map_routes.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include "api/answers.hpp"
#include "api/map_json.hpp"
#include "api/route.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"
#include "picture/palette.hpp"

namespace adit::api {
namespace {

using icd::Status;

constexpr Time kLongest = 10;  // seconds, as between the poses of a robot that stands

TrackPose interpolate(const TrackPose& from, const TrackPose& to, Time at) {
  const double part = (at - from.at) / (to.at - from.at);
  const auto mix = [part](double one, double other) { return one + part * (other - one); };
  return {.at = at,
          .position = {mix(from.position.x, to.position.x), mix(from.position.y, to.position.y),
                       mix(from.position.z, to.position.z)},
          .heading = from.heading + part * std::remainder(to.heading - from.heading, 2 * M_PI)};
}

bool is_straight(std::span<const TrackPose> way) {
  const TrackPose &from = way.front(), &to = way.back();
  if (to.at <= from.at || to.at > from.at + kLongest) return false;
  return std::ranges::none_of(way.subspan(1, way.size() - 2), [&](const TrackPose& pose) {
    return has_moved(interpolate(from, to, pose.at), pose);
  });
}

std::vector<TrackPose> thin_tracks(std::span<const TrackPose> poses) {
  std::vector<TrackPose> kept;
  for (std::size_t i = 0; i < poses.size();) {
    kept.push_back(poses[i]);
    std::size_t next = i + 1;
    while (next + 1 < poses.size() && is_straight(poses.subspan(i, next + 2 - i))) ++next;
    i = next;
  }
  return kept;
}

/// Leaves out poses that lie on a straight way, so that interpolation in time between the others gives each
/// of them back (has_moved() tells no difference). A way is at most 10 s long. First and last pose stay.
Tracks thin_tracks(std::vector<Track> tracks) {
  for (Track& track : tracks) track.poses = thin_tracks(track.poses);
  return {std::move(tracks)};
}

constexpr std::string_view kMerged = "-";  // stands for the robot "", which a path cannot name

struct LayerRequest {
  picture::Layer layer;
  std::optional<double> stamp, low, high;
  std::optional<picture::Colour> from, to;  // for free or lowest, and for occupied or highest
};

/// A request for a tile: place, colours, and the client's cached state.
struct TileRequest {
  LayerRequest in;
  picture::TileIndex at;
  std::string has;  // If-None-Match
};

struct TilesRequest {
  static constexpr std::size_t kMost = 64;

  LayerRequest in;
  std::vector<picture::TileIndex> at;
};

/// One of several tiles in an answer.
struct TileHead {
  std::string place = {};
  std::size_t bytes = 0;
  std::optional<double> since = {}, until = {};
  static const codec::Row kRow;
};

struct TilesHead {
  std::vector<TileHead> tiles = {};
  static const codec::Row kRow;
};

constexpr codec::Member kTileHead[] = {
    codec::member<&TileHead::place>("place"), codec::member<&TileHead::bytes>("bytes"),
    codec::member<&TileHead::since>("since"), codec::member<&TileHead::until>("until")};
constexpr codec::Row TileHead::kRow = codec::complete<TileHead>({"", kTileHead});
constexpr codec::Member kTilesHead[] = {codec::member<&TilesHead::tiles>("tiles")};
constexpr codec::Row TilesHead::kRow = codec::complete<TilesHead>({"", kTilesHead});

/// A colour of six hexadecimal digits.
std::optional<picture::Colour> colour_in(std::string_view text) {
  const auto value = icd::number_in<std::uint32_t>(text, 16);
  if (!value || text.size() != 6) return std::nullopt;
  const auto part = [value](int shift) { return static_cast<std::uint8_t>(*value >> shift); };
  return picture::Colour{part(16), part(8), part(0)};
}

std::string colour_tile(const picture::PackedTile& tile, const LayerRequest& asked) {
  const bool is_coloured = asked.from && asked.to;
  if (asked.layer.kind == picture::LayerKind::Grid) {
    return is_coloured ? picture::write_png(tile, picture::grid_palette(*asked.from, *asked.to))
                       : picture::write_png(tile, picture::grid_palette());
  }
  const double low = asked.low.value_or(picture::kLowest), high = asked.high.value_or(picture::kHighest);
  return picture::write_png(tile, is_coloured ? picture::cloud_palette(low, high, *asked.from, *asked.to)
                                              : picture::cloud_palette(low, high));
}

/// Identifies a tile's state across restarts.
std::string etag_of(const picture::PackedTile& tile) {
  return icd::sentence("\"", tile.crc, "-", tile.deflated.size(), "\"");
}

intake::Answer no_tile_answer() {
  return refusal(icd::Status::NotFound, "this tile is empty");
}

intake::Answer image_of(const picture::PackedTile& tile, const TileRequest& asked, std::string_view kept) {
  intake::Answer answer{.content_type = "image/png", .body = {}, .headers = {}};
  const std::string etag = etag_of(tile);
  answer.headers = {{"ETag", etag}, {"Cache-Control", std::string(kept)}};
  if (asked.has.contains(etag)) {
    answer.status = kNotModified;
  } else {
    answer.body = colour_tile(tile, asked.in);
  }
  return answer;
}

/// The number in ?since=, or 0 without it.
icd::Checked<std::uint64_t> version_asked(const intake::RequestHead& head) {
  const std::string_view text = head.query("since");
  const auto version = text.empty() ? 0 : icd::number_in<std::uint64_t>(text);
  if (!version) return icd::refuse(Status::BadRequest, "since: expected a version, a whole number");
  return *version;
}

icd::Checked<Time> time_asked(const intake::RequestHead& head) {
  const auto since = ADIT_TRY(asked_number(head, "since", "since: expected seconds since 1970"));
  return since.value_or(0);
}

/// `parts`: kind and robot from the path.
icd::Checked<LayerRequest> layer_asked(const intake::RequestHead& head, std::span<const std::string> parts) {
  if (parts[0] != "grid" && parts[0] != "cloud") return std::unexpected(nothing_at(head.path()));
  const auto at = ADIT_TRY(asked_number(head, "at", "at: expected seconds since 1970"));
  const auto low = ADIT_TRY(asked_number(head, "low", "low and high: expected metres"));
  const auto high = ADIT_TRY(asked_number(head, "high", "low and high: expected metres"));
  const std::string_view from_text = head.query("from"), to_text = head.query("to");
  const auto from = colour_in(from_text), to = colour_in(to_text);
  if (!(from && to) && !(from_text.empty() && to_text.empty()))
    return icd::refuse(Status::BadRequest,
                       "from and to: expected both or neither, each with six hexadecimal digits, as in "
                       "2266ee");
  return LayerRequest{
      .layer = {.robot = parts[1] == kMerged ? "" : parts[1],
                .kind = parts[0] == "grid" ? picture::LayerKind::Grid : picture::LayerKind::Cloud},
      .stamp = at,
      .low = low,
      .high = high,
      .from = from,
      .to = to};
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (!text.empty()) parts.emplace_back(icd::cut(text, separator));
  return parts;
}

/// `parts`: level, x and y.
std::optional<picture::TileIndex> place_in(std::span<const std::string> parts) {
  if (parts.size() != 3) return std::nullopt;
  const auto level = icd::number_in<int>(parts[0]), x = icd::number_in<int>(parts[1]),
             y = icd::number_in<int>(parts[2]);
  if (!level || !x || !y) return std::nullopt;
  return picture::TileIndex{*level, *x, *y};
}

/// `parts`: kind, robot, level, x and y from the path.
icd::Checked<TileRequest> tile_asked(const intake::RequestHead& head, std::span<const std::string> parts) {
  auto in = ADIT_TRY(layer_asked(head, parts.first(2)));
  const auto at = place_in(parts.subspan(2));
  if (!at) return std::unexpected(nothing_at(head.path()));
  if (in.stamp && at->level < 0)
    return icd::refuse(Status::BadRequest, "at: finer levels exist only for now");
  return TileRequest{.in = std::move(in), .at = *at, .has = std::string(head.header("If-None-Match"))};
}

/// `parts`: kind and robot from the path.
icd::Checked<TilesRequest> tiles_asked(const intake::RequestHead& head, std::span<const std::string> parts) {
  TilesRequest asked{.in = ADIT_TRY(layer_asked(head, parts.first(2))), .at = {}};
  const auto places = split(head.query("tiles"), ',');
  bool is_valid = !places.empty() && places.size() <= TilesRequest::kMost;
  for (const std::string& place : places) {
    const auto at = place_in(split(place, '/'));
    is_valid = is_valid && at && at->level >= 0;
    if (is_valid) asked.at.push_back(*at);
  }
  if (is_valid) return asked;
  return icd::refuse(Status::BadRequest,
                     icd::sentence("tiles: expected 1 to ", TilesRequest::kMost,
                                   " places with commas between them, as in 0/3/-2,0/4/-2"));
}

/// The PNG, or the reason for its absence.
intake::Answer tile_of(const picture::Mosaic& map, const TileRequest& asked) {
  const auto shown = map.tile(asked.in.layer, asked.at, asked.in.stamp);
  if (shown.tile == nullptr) return no_tile_answer();
  // An earlier state never changes; the newest must be revalidated.
  intake::Answer answer = image_of(*shown.tile, asked, shown.newest ? "no-cache" : "max-age=3600");
  // So that a replay requests a tile only when it changes.
  answer.headers.push_back({"Adit-Since", icd::number_text(shown.stamp)});
  if (shown.until) answer.headers.push_back({"Adit-Until", icd::number_text(*shown.until)});
  return add_headers(std::move(answer));
}

/// A line with the head of each tile in JSON, then their PNGs.
intake::Answer tiles_of(const picture::Mosaic& map, const TilesRequest& asked) {
  TilesHead head;
  std::string images;
  for (const picture::TileIndex& at : asked.at) {
    TileHead& tile = head.tiles.emplace_back(icd::sentence(at.level, "/", at.x, "/", at.y));
    const auto shown = map.tile(asked.in.layer, at, asked.in.stamp);
    if (shown.tile == nullptr) continue;
    const std::string image = colour_tile(*shown.tile, asked.in);
    tile.bytes = image.size();
    tile.since = shown.stamp;
    tile.until = shown.until;
    images += image;
  }
  return uncached_answer("application/octet-stream", codec::to_json(head) + '\n' + images);
}

/// The same for a drawn tile of a finer level. Null: 204, because the client cannot know which tiles exist.
intake::Answer finer_tile(const picture::Tile& tile, const TileRequest& asked) {
  return add_headers(tile ? image_of(*tile, asked, "no-cache")
                          : intake::Answer{.status = icd::Status::NoContent,
                                           .body = {},
                                           .headers = {{"Cache-Control", "no-store"}}});
}

}  // namespace

icd::Checked<MapView> MapRoutes::layers(const intake::RequestHead& head) const {
  const auto since = ADIT_TRY(version_asked(head));
  MapView view = map_view(source_.map(), since);
  for (picture::LayerView& layer : view.layers) layer.finer = finer_.finer_levels(layer.layer, since);
  return view;
}

icd::Checked<MarkerChanges> MapRoutes::markers(const intake::RequestHead& head) const {
  const auto since = ADIT_TRY(version_asked(head));
  return source_.markers(since);
}

icd::Checked<Tracks> MapRoutes::tracks(const intake::RequestHead& head) const {
  const auto since = ADIT_TRY(time_asked(head));
  return thin_tracks(source_.tracks(since));
}

void MapRoutes::tile(const Call& call) const {
  const auto asked = tile_asked(call.head, call.parameters);
  if (!asked) return call.responder->answer(refusal_answer(asked.error()));
  if (asked->at.level >= 0 || !picture::is_in_world(asked->at))
    return call.responder->answer(tile_of(source_.map(), *asked));
  finer_.tile(asked->in.layer, asked->at,
              [responder = call.responder, asked = *asked](const icd::Checked<picture::Tile>& tile) {
                responder->answer(tile ? finer_tile(*tile, asked) : refusal_answer(tile.error()));
              });
}

void MapRoutes::tiles(const Call& call) const {
  const auto asked = tiles_asked(call.head, call.parameters);
  call.responder->answer(asked ? tiles_of(source_.map(), *asked) : refusal_answer(asked.error()));
}

void MapRoutes::covered(const Call& call) const {
  covered_.count([responder = call.responder](const icd::Checked<picture::Coverage>& covered) {
    responder->answer(covered ? uncached_answer(covered_view(*covered)) : refusal_answer(covered.error()));
  });
}

namespace {

constexpr std::size_t kDetailsInATurn = 16;  // each is a query of the ledger

/// A run's report contains its style and images, and no script. Other content must not load.
intake::Answer html_answer(std::string html) {
  return {.content_type = "text/html; charset=utf-8",
          .body = std::move(html),
          .headers = {{"Content-Security-Policy",
                       "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; "
                       "frame-ancestors 'none'; form-action 'none'"},
                      {"X-Content-Type-Options", "nosniff"},
                      {"Referrer-Policy", "no-referrer"},
                      {"Cache-Control", "no-store"}}};
}

}  // namespace

KeptRunsRoutes::KeptRunsRoutes(loop::Loop& loop, KeptRuns& runs, Source& source)
    : loop_(loop), runs_(runs), source_(source), forget_(loop.timer([this] { held_.reset(); })) {}

icd::Checked<RunRow> KeptRunsRoutes::row_of(const std::string& key) const {
  const RunList all = runs_.list();
  const auto found = std::ranges::find(all.runs, key, &RunRow::key);
  if (found != all.runs.end()) return *found;
  if (all.unreadable.empty()) return std::unexpected(no_such_run());
  return icd::refuse(Status::ServiceUnavailable, all.unreadable);
}

icd::Checked<History> KeptRunsRoutes::history(const intake::RequestHead& head) const {
  const auto since = ADIT_TRY(time_asked(head));
  return runs_.history(since);
}

void KeptRunsRoutes::with_run(const Call& call, Answering answer) {
  const std::string& key = call.parameters.front();
  if (held_ && held_->facts.key == key) {
    forget_.call_at(loop_.now() + kHeld);
    return call.responder->answer(answer(*held_));
  }
  auto& waiting = waiting_[key];
  if (waiting.size() >= kMostWaiting) {
    return call.responder->answer(refusal(icd::Status::ServiceUnavailable, "the run is being read"));
  }
  waiting.push_back({call.responder, std::move(answer)});
  if (waiting.size() > 1) return;
  runs_.read(key, [this, key](const auto& run) { on_run_read(key, run); });
}

void KeptRunsRoutes::on_run_read(const std::string& key,
                                 const icd::Checked<std::shared_ptr<const KeptRun>>& run) {
  const auto waiting = std::exchange(waiting_[key], {});
  waiting_.erase(key);
  for (const QueuedRequest& each : waiting)
    each.responder->answer(run ? each.answer(**run) : refusal_answer(run.error()));
  const auto row = row_of(key);
  if (!run || !row || row->is_present) return;  // the present run changes
  held_ = *run;
  forget_.call_at(loop_.now() + kHeld);
}

void KeptRunsRoutes::layers(const Call& call) {
  const auto since = version_asked(call.head);
  if (!since) return call.responder->answer(refusal_answer(since.error()));
  with_run(call,
           [since = *since](const KeptRun& run) { return uncached_answer(map_view(run.picture, since)); });
}

void KeptRunsRoutes::tile(const Call& call) {
  const auto asked = tile_asked(call.head, std::span(call.parameters).subspan(1));
  if (!asked) return call.responder->answer(refusal_answer(asked.error()));
  with_run(call, [asked = *asked](const KeptRun& run) { return tile_of(run.picture, asked); });
}

void KeptRunsRoutes::tiles(const Call& call) {
  const auto asked = tiles_asked(call.head, std::span(call.parameters).subspan(1));
  if (!asked) return call.responder->answer(refusal_answer(asked.error()));
  with_run(call, [asked = *asked](const KeptRun& run) { return tiles_of(run.picture, asked); });
}

void KeptRunsRoutes::tracks(const Call& call) {
  with_run(call, [](const KeptRun& run) { return uncached_answer(thin_tracks(run.tracks)); });
}

void KeptRunsRoutes::plots(const Call& call) {
  with_run(call, [](const KeptRun& run) { return uncached_answer(run.history); });
}

/// Collects the reports of a run, some in each turn of the loop.
struct KeptRunsRoutes::ReportCollector {
  std::string key;
  std::int64_t run = 0, last = 0;
  std::vector<ReportDetail> reports;
  std::shared_ptr<intake::Responder> responder;
};

void KeptRunsRoutes::report(const Call& call) {
  const auto row = row_of(call.parameters.front());
  if (!row) return call.responder->answer(refusal_answer(row.error()));
  collect_reports(
      std::make_shared<ReportCollector>(row->key, row->run, 0, std::vector<ReportDetail>(), call.responder));
}

void KeptRunsRoutes::collect_reports(const std::shared_ptr<ReportCollector>& gathering) {
  const auto rows = source_.reports(gathering->last, kDetailsInATurn);
  for (const facts::ReportRow& row : rows) {
    gathering->last = row.number;
    if (row.run != gathering->run) continue;
    if (auto detail = source_.report(row.number)) gathering->reports.push_back(std::move(*detail));
  }
  if (rows.size() == kDetailsInATurn) {
    return loop_.post([this, gathering] { collect_reports(gathering); });
  }
  runs_.report(gathering->key, std::move(gathering->reports), source_.view().colours,
               [responder = gathering->responder](icd::Checked<std::string> html) {
                 responder->answer(html ? html_answer(*std::move(html)) : refusal_answer(html.error()));
               });
}

void KeptRunsRoutes::remove(const Call& call) {
  const auto row = row_of(call.parameters.front());
  if (!row) return call.responder->answer(refusal_answer(row.error()));
  if (held_ && held_->facts.key == row->key) held_.reset();
  runs_.remove(row->key,
               [key = row->key, responder = call.responder](const std::expected<void, std::string>& done) {
                 responder->answer(done ? object({{"key", codec::json(key)}})
                                        : refusal(icd::Status::Conflict, done.error()));
               });
}

}  // namespace adit::api
