#include "api/map_routes.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include "api/answers.hpp"
#include "api/map_json.hpp"
#include "api/number_in.hpp"
#include "icd/sentence.hpp"
#include "picture/png.hpp"

namespace adit::api {
namespace {

constexpr std::string_view kMerged = "-";  // for the robot "", which no path could name

struct TilePath {
  picture::Layer layer;
  picture::TileAt at;
};

/// Of kind, robot, level, x and y.
std::optional<TilePath> tile_path(const std::vector<std::string>& parts) {
  if (parts[0] != "grid" && parts[0] != "cloud") return {};
  const auto level = number_in<int>(parts[2]), x = number_in<int>(parts[3]), y = number_in<int>(parts[4]);
  if (!level || !x || !y) return {};
  return TilePath{{.robot = parts[1] == kMerged ? "" : parts[1],
                   .kind = parts[0] == "grid" ? picture::Kind::Grid : picture::Kind::Cloud},
                  {*level, *x, *y}};
}

/// A number of the query: absent, or a finite one, or no number at all.
struct Asked {
  std::optional<double> number;
  bool wrong = false;
};
Asked asked(const intake::RequestHead& head, std::string_view name) {
  const std::string_view text = head.query(name);
  if (text.empty()) return {};
  const auto number = number_in<double>(text);
  if (!number || !std::isfinite(*number)) return {.number = {}, .wrong = true};
  return {.number = number};
}

/// Of ?since=, 0 without it.
std::optional<std::uint64_t> version_in(const intake::RequestHead& head) {
  const std::string_view text = head.query("since");
  return text.empty() ? 0 : number_in<std::uint64_t>(text);
}
constexpr std::string_view kNoVersion = "since: expected a version, a whole number";

intake::Answer bad_query(std::string_view sentence) {
  return refusal(icd::Status::BadRequest, sentence);
}

/// Says which state of a tile it is, whatever the box was restarted for since.
std::string etag_of(const picture::Packed& tile) {
  return icd::sentence("\"", tile.crc, "-", tile.deflated.size(), "\"");
}

}  // namespace

intake::Answer MapRoutes::layers(const intake::RequestHead& head) const {
  const auto since = version_in(head);
  if (!since) return bad_query(kNoVersion);
  return fresh("application/json", codec::to_json(map_view(source_.map(), *since)));
}

intake::Answer MapRoutes::markers(const intake::RequestHead& head) const {
  const auto since = version_in(head);
  if (!since) return bad_query(kNoVersion);
  return fresh("application/json", codec::to_json(source_.markers(*since)));
}

intake::Answer MapRoutes::tracks(const intake::RequestHead& head) const {
  const Asked since = asked(head, "since");
  if (since.wrong) return bad_query("since: expected seconds since 1970");
  return fresh("application/json", codec::to_json(Tracks{source_.tracks(since.number.value_or(0))}));
}

intake::Answer MapRoutes::tile(const Call& call) const {
  const intake::RequestHead& head = call.head;
  const auto path = tile_path(call.parameters);
  if (!path) return nothing_here();
  const Asked at = asked(head, "at"), low = asked(head, "low"), high = asked(head, "high");
  if (at.wrong) return bad_query("at: expected seconds since 1970");
  if (low.wrong || high.wrong) return bad_query("low and high: expected metres");
  const auto shown = source_.map().tile(path->layer, path->at, at.number);
  if (shown.tile == nullptr) return refusal(icd::Status::NotFound, "nothing is drawn here");

  intake::Answer answer{.content_type = "image/png", .body = {}, .headers = {}};
  const std::string etag = etag_of(*shown.tile);
  answer.headers.push_back({"ETag", etag});
  // What was followed by another state does not change any more; the newest is asked for each time.
  answer.headers.push_back({"Cache-Control", shown.newest ? "no-cache" : "max-age=3600"});
  if (head.header("If-None-Match").contains(etag)) {
    answer.status = kNotModified;
  } else if (path->layer.kind == picture::Kind::Grid) {
    answer.body = picture::write_png(*shown.tile, picture::grid_palette());
  } else {
    answer.body =
        picture::write_png(*shown.tile, picture::cloud_palette(low.number.value_or(picture::kLowest),
                                                               high.number.value_or(picture::kHighest)));
  }
  return guarded(std::move(answer));
}

}  // namespace adit::api
