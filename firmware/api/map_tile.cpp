#include "api/map_tile.hpp"

#include <utility>

#include "api/answers.hpp"
#include "api/asked_number.hpp"
#include "api/number_in.hpp"
#include "icd/sentence.hpp"
#include "picture/png.hpp"

namespace adit::api {
namespace {

constexpr std::string_view kMerged = "-";  // for the robot "", which no path could name

intake::Answer bad_tile(std::string_view sentence) {
  return refusal(icd::Status::BadRequest, sentence);
}

/// Says which state of a tile it is, whatever the box was restarted for since.
std::string etag_of(const picture::Packed& tile) {
  return icd::sentence("\"", tile.crc, "-", tile.deflated.size(), "\"");
}

}  // namespace

std::expected<std::uint64_t, intake::Answer> version_asked(const intake::RequestHead& head) {
  const std::string_view text = head.query("since");
  const auto version = text.empty() ? 0 : number_in<std::uint64_t>(text);
  if (!version) return std::unexpected(bad_tile("since: expected a version, a whole number"));
  return *version;
}

std::expected<TileAsked, intake::Answer> tile_asked(const intake::RequestHead& head,
                                                    std::span<const std::string> parts) {
  if (parts[0] != "grid" && parts[0] != "cloud") return std::unexpected(nothing_here());
  const auto level = number_in<int>(parts[2]), x = number_in<int>(parts[3]), y = number_in<int>(parts[4]);
  if (!level || !x || !y) return std::unexpected(nothing_here());
  const AskedNumber at = asked_number(head, "at"), low = asked_number(head, "low"),
                    high = asked_number(head, "high");
  if (at.wrong) return std::unexpected(bad_tile("at: expected seconds since 1970"));
  if (low.wrong || high.wrong) return std::unexpected(bad_tile("low and high: expected metres"));
  return TileAsked{.layer = {.robot = parts[1] == kMerged ? "" : parts[1],
                             .kind = parts[0] == "grid" ? picture::Kind::Grid : picture::Kind::Cloud},
                   .at = {*level, *x, *y},
                   .stamp = at.number,
                   .low = low.number,
                   .high = high.number,
                   .has = std::string(head.header("If-None-Match"))};
}

intake::Answer tile_of(const picture::Mosaic& map, const TileAsked& asked) {
  const auto shown = map.tile(asked.layer, asked.at, asked.stamp);
  if (shown.tile == nullptr) return refusal(icd::Status::NotFound, "nothing is drawn here");

  intake::Answer answer{.content_type = "image/png", .body = {}, .headers = {}};
  const std::string etag = etag_of(*shown.tile);
  answer.headers.push_back({"ETag", etag});
  // What was followed by another state does not change any more; the newest is asked for each time.
  answer.headers.push_back({"Cache-Control", shown.newest ? "no-cache" : "max-age=3600"});
  if (asked.has.contains(etag)) {
    answer.status = kNotModified;
  } else if (asked.layer.kind == picture::Kind::Grid) {
    answer.body = picture::write_png(*shown.tile, picture::grid_palette());
  } else {
    answer.body = picture::write_png(
        *shown.tile,
        picture::cloud_palette(asked.low.value_or(picture::kLowest), asked.high.value_or(picture::kHighest)));
  }
  return guarded(std::move(answer));
}

}  // namespace adit::api
