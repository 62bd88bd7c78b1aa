#include "api/map_routes.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include "api/answers.hpp"
#include "api/map_json.hpp"
#include "api/read_body.hpp"
#include "icd/sentence.hpp"
#include "picture/palette.hpp"

namespace adit::api {
namespace {

constexpr Time kLongest = 10;  // seconds, as between the poses of a robot that stands

TrackPose between(const TrackPose& from, const TrackPose& to, Time at) {
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
    return has_moved(between(from, to, pose.at), pose);
  });
}

std::vector<TrackPose> thinned(std::span<const TrackPose> poses) {
  std::vector<TrackPose> kept;
  for (std::size_t i = 0; i < poses.size();) {
    kept.push_back(poses[i]);
    std::size_t next = i + 1;
    while (next + 1 < poses.size() && is_straight(poses.subspan(i, next + 2 - i))) ++next;
    i = next;
  }
  return kept;
}

}  // namespace

Tracks thinned(std::vector<Track> tracks) {
  for (Track& track : tracks) track.poses = thinned(track.poses);
  return {std::move(tracks)};
}

namespace {

constexpr std::string_view kMerged = "-";  // stands for the robot "", which a path cannot name

intake::Answer bad_tile(std::string_view sentence) {
  return refusal(icd::Status::BadRequest, sentence);
}

/// A colour in the query, six digits without "#". `wrong`: present but invalid.
struct AskedColour {
  std::optional<picture::Colour> colour;
  bool wrong = false;
};

AskedColour asked_colour(const intake::RequestHead& head, std::string_view name) {
  const std::string_view text = head.query(name);
  if (text.empty()) return {};
  const auto value = icd::number_in<std::uint32_t>(text, 16);
  if (!value || text.size() != 6) return {.colour = {}, .wrong = true};
  const auto part = [value](int shift) { return static_cast<std::uint8_t>(*value >> shift); };
  return {.colour = picture::Colour{part(16), part(8), part(0)}};
}

std::string coloured(const picture::Packed& tile, const TileAsked& asked) {
  const bool is_coloured = asked.from && asked.to;
  if (asked.layer.kind == picture::Kind::Grid) {
    return is_coloured ? picture::write_png(tile, picture::grid_palette(*asked.from, *asked.to))
                       : picture::write_png(tile, picture::grid_palette());
  }
  const double low = asked.low.value_or(picture::kLowest), high = asked.high.value_or(picture::kHighest);
  return picture::write_png(tile, is_coloured ? picture::cloud_palette(low, high, *asked.from, *asked.to)
                                              : picture::cloud_palette(low, high));
}

/// Identifies a tile's state across restarts.
std::string etag_of(const picture::Packed& tile) {
  return icd::sentence("\"", tile.crc, "-", tile.deflated.size(), "\"");
}

intake::Answer nothing_drawn() {
  return refusal(icd::Status::NotFound, "this tile is empty");
}

intake::Answer image_of(const picture::Packed& tile, const TileAsked& asked, std::string_view kept) {
  intake::Answer answer{.content_type = "image/png", .body = {}, .headers = {}};
  const std::string etag = etag_of(tile);
  answer.headers = {{"ETag", etag}, {"Cache-Control", std::string(kept)}};
  if (asked.has.contains(etag)) {
    answer.status = kNotModified;
  } else {
    answer.body = coloured(tile, asked);
  }
  return answer;
}

}  // namespace

std::expected<std::uint64_t, intake::Answer> version_asked(const intake::RequestHead& head) {
  const std::string_view text = head.query("since");
  const auto version = text.empty() ? 0 : icd::number_in<std::uint64_t>(text);
  if (!version) return std::unexpected(bad_tile("since: expected a version, a whole number"));
  return *version;
}

std::expected<TileAsked, intake::Answer> tile_asked(const intake::RequestHead& head,
                                                    std::span<const std::string> parts) {
  if (parts[0] != "grid" && parts[0] != "cloud") return std::unexpected(nothing_at(head.path()));
  const auto level = icd::number_in<int>(parts[2]), x = icd::number_in<int>(parts[3]),
             y = icd::number_in<int>(parts[4]);
  if (!level || !x || !y) return std::unexpected(nothing_at(head.path()));
  const AskedNumber at = asked_number(head, "at"), low = asked_number(head, "low"),
                    high = asked_number(head, "high");
  if (at.wrong) return std::unexpected(bad_tile("at: expected seconds since 1970"));
  if (at.number && *level < 0) return std::unexpected(bad_tile("at: finer levels exist only for now"));
  if (low.wrong || high.wrong) return std::unexpected(bad_tile("low and high: expected metres"));
  const AskedColour from = asked_colour(head, "from"), to = asked_colour(head, "to");
  if (from.wrong || to.wrong || from.colour.has_value() != to.colour.has_value()) {
    return std::unexpected(
        bad_tile("from and to: expected both or neither, each with six hexadecimal digits, as in 2266ee"));
  }
  return TileAsked{.layer = {.robot = parts[1] == kMerged ? "" : parts[1],
                             .kind = parts[0] == "grid" ? picture::Kind::Grid : picture::Kind::Cloud},
                   .at = {*level, *x, *y},
                   .stamp = at.number,
                   .low = low.number,
                   .high = high.number,
                   .from = from.colour,
                   .to = to.colour,
                   .has = std::string(head.header("If-None-Match"))};
}

intake::Answer tile_of(const picture::Mosaic& map, const TileAsked& asked) {
  const auto shown = map.tile(asked.layer, asked.at, asked.stamp);
  if (shown.tile == nullptr) return nothing_drawn();
  // An earlier state never changes; the newest must be revalidated.
  intake::Answer answer = image_of(*shown.tile, asked, shown.newest ? "no-cache" : "max-age=3600");
  // So that a replay requests a tile only when it changes.
  answer.headers.push_back({"Adit-Since", icd::number_text(shown.stamp)});
  if (shown.until) answer.headers.push_back({"Adit-Until", icd::number_text(*shown.until)});
  return guarded(std::move(answer));
}

intake::Answer finer_tile(const picture::Tile& tile, const TileAsked& asked) {
  return guarded(tile ? image_of(*tile, asked, "no-cache")
                      : intake::Answer{.status = icd::Status::NoContent,
                                       .body = {},
                                       .headers = {{"Cache-Control", "no-store"}}});
}

intake::Answer MapRoutes::layers(const intake::RequestHead& head) const {
  const auto since = version_asked(head);
  if (!since) return since.error();
  MapView view = map_view(source_.map(), *since);
  for (picture::LayerView& layer : view.layers) layer.finer = finer_.finer(layer.layer, *since);
  return fresh(view);
}

intake::Answer MapRoutes::markers(const intake::RequestHead& head) const {
  const auto since = version_asked(head);
  if (!since) return since.error();
  return fresh(source_.markers(*since));
}

intake::Answer MapRoutes::tracks(const intake::RequestHead& head) const {
  const AskedNumber since = asked_number(head, "since");
  if (since.wrong) return refusal(icd::Status::BadRequest, "since: expected seconds since 1970");
  return fresh(thinned(source_.tracks(since.number.value_or(0))));
}

void MapRoutes::tile(const Call& call) const {
  const auto asked = tile_asked(call.head, call.parameters);
  if (!asked) return call.responder->answer(asked.error());
  if (asked->at.level >= 0 || !picture::is_in_world(asked->at))
    return call.responder->answer(tile_of(source_.map(), *asked));
  finer_.tile(asked->layer, asked->at,
              [responder = call.responder, asked = *asked](const icd::Checked<picture::Tile>& tile) {
                responder->answer(tile ? finer_tile(*tile, asked) : refused(tile.error()));
              });
}

void MapRoutes::covered(const Call& call) const {
  covered_.covered([responder = call.responder](const icd::Checked<picture::Covered>& covered) {
    responder->answer(covered ? fresh(covered_view(*covered)) : refused(covered.error()));
  });
}

}  // namespace adit::api
