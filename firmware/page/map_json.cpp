#include "page/map_json.hpp"

#include "codec/json.hpp"
#include "page/as_json.hpp"
#include "picture/palette.hpp"

namespace adit::page {
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
  return {Value::Object{{"left", page::json(area.left)},
                        {"bottom", page::json(area.bottom)},
                        {"right", page::json(area.right)},
                        {"top", page::json(area.top)}}};
}

Value json(const picture::Heights& heights) {
  return {Value::Object{{"low", page::json(heights.low)}, {"high", page::json(heights.high)}}};
}

Value json(const picture::TileView& tile) {
  return {Value::Object{{"level", page::json(tile.at.level)},
                        {"x", page::json(tile.at.x)},
                        {"y", page::json(tile.at.y)},
                        {"first", page::json(tile.first)},
                        {"stamp", page::json(tile.stamp)},
                        {"version", page::json(tile.version)},
                        {"blank", page::json(tile.blank)}}};
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
      {"robot", page::json(view.layer.robot)},
      {"kind", page::json(std::string(view.layer.kind == picture::Kind::Grid ? "grid" : "cloud"))},
      {"bounds", or_null(view.bounds)},
      {"heights", or_null(view.heights)},
      {"first", page::json(view.first)},
      {"last", page::json(view.last)},
      {"version", page::json(view.version)},
      {"missed", page::json(view.missed)},
      {"left_out", page::json(view.left_out)},
      {"tiles", array_of(view.tiles)}}};
}

Value scales() {
  Value::Array array;
  for (const double metres : picture::kMetresPerPixel) array.push_back(page::json(metres));
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
  return codec::write_json({Value::Object{{"version", page::json(map.version())},
                                          {"tile_side", page::json(picture::kSide)},
                                          {"metres_per_pixel", scales()},
                                          {"colours", colours()},
                                          {"spacing", page::json(map.spacing())},
                                          {"wiped", page::json(map.wiped())},
                                          {"layers", array_of(map.layers(since))}}});
}

}  // namespace adit::page
