#include "api/map_json.hpp"

#include "api/as_json.hpp"
#include "codec/json.hpp"
#include "picture/palette.hpp"

namespace adit::api {
namespace {

using codec::Value;

Value json(const picture::Colour& colour) {  // as CSS has it: "#c8d2da"
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "#";
  for (const std::uint8_t part : {colour.red, colour.green, colour.blue}) {
    text += kDigits[part >> 4];
    text += kDigits[part & 15];
  }
  return {std::move(text)};
}

Value json(const picture::Area& area) {
  return {Value::Object{{"left", api::json(area.left)},
                        {"bottom", api::json(area.bottom)},
                        {"right", api::json(area.right)},
                        {"top", api::json(area.top)}}};
}

Value json(const picture::Heights& heights) {
  return {Value::Object{{"low", api::json(heights.low)}, {"high", api::json(heights.high)}}};
}

Value json(const picture::TileView& tile) {
  return {Value::Object{{"level", api::json(tile.at.level)},
                        {"x", api::json(tile.at.x)},
                        {"y", api::json(tile.at.y)},
                        {"first", api::json(tile.first)},
                        {"stamp", api::json(tile.stamp)},
                        {"version", api::json(tile.version)},
                        {"blank", api::json(tile.blank)}}};
}

Value json(const picture::LayerView& view);

template <class Each>
Value array_of(const Each& each) {
  Value::Array array;
  for (const auto& one : each) array.push_back(json(one));
  return {std::move(array)};
}

template <class T>
Value or_null(const std::optional<T>& value) {
  return value ? json(*value) : Value{};
}

Value json(const picture::LayerView& view) {
  return {Value::Object{
      {"robot", api::json(view.layer.robot)},
      {"kind", api::json(std::string(view.layer.kind == picture::Kind::Grid ? "grid" : "cloud"))},
      {"bounds", or_null(view.bounds)},
      {"heights", or_null(view.heights)},
      {"first", api::json(view.first)},
      {"last", api::json(view.last)},
      {"version", api::json(view.version)},
      {"missed", api::json(view.missed)},
      {"left_out", api::json(view.left_out)},
      {"tiles", array_of(view.tiles)}}};
}

Value scales() {
  Value::Array array;
  for (const double metres : picture::kMetresPerPixel) array.push_back(api::json(metres));
  return {std::move(array)};
}

Value colours() {
  const auto grid = picture::grid_palette();
  return {Value::Object{{"free", json(grid[1])},
                        {"occupied", json(grid[picture::kMostOccupiedIndex])},
                        {"heights", array_of(picture::height_ramp())}}};
}

}  // namespace

std::string write_map(const picture::Mosaic& map, std::uint64_t since) {
  return codec::write_json({Value::Object{{"version", api::json(map.version())},
                                          {"tile_side", api::json(picture::kSide)},
                                          {"metres_per_pixel", scales()},
                                          {"colours", colours()},
                                          {"spacing", api::json(map.spacing())},
                                          {"wiped", api::json(map.wiped())},
                                          {"layers", array_of(map.layers(since))}}});
}

}  // namespace adit::api
