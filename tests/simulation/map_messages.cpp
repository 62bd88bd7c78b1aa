// Grids and clouds, each made of its serial.
#include "simulation/map_messages.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <ranges>

#include "simulation/bad_messages.hpp"
#include "simulation/bytes.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {
namespace {

constexpr std::size_t kSerialCells = 4;  // cells of a bad grid that hold its serial, each a digit of base 100
constexpr std::int64_t kPointsApart =
    512;  // a point's intensity is this times the serial, plus the point's index
constexpr std::int64_t kInvalidEvery = 17;
constexpr std::size_t kRowWidth = 4;  // every cloud has more points
constexpr double kPacking = 0.0013;   // metres by which packing may move a point

std::array<float, 3> place_of(std::int64_t serial, std::int64_t index) {
  return {static_cast<float>(index) * 0.37F, static_cast<float>(serial % 97) * 1.5F,
          static_cast<float>((serial * 7 + index * 13) % 100) * -0.01F};
}

void put(std::string& bytes, std::size_t at, float value, bool big_endian) {
  auto raw = std::bit_cast<std::array<char, 4>>(value);
  if (big_endian) std::ranges::reverse(raw);
  std::ranges::copy(raw, bytes.begin() + static_cast<std::ptrdiff_t>(at));
}

float get(const std::string& bytes, std::size_t at, bool big_endian) {
  std::array<char, 4> raw{};
  std::memcpy(raw.data(), bytes.data() + at, raw.size());
  if (big_endian) std::ranges::reverse(raw);
  return std::bit_cast<float>(raw);
}

/// Noise of that point, which does not compress.
std::string noise_of(std::int64_t serial, std::int64_t index, std::size_t size) {
  Random random(static_cast<std::uint64_t>(serial * kPointsApart + index), "noise");
  std::string noise(size, '\0');
  for (std::size_t at = 0; at < size; at += sizeof(std::uint64_t)) {
    const std::uint64_t next = random.next();
    std::memcpy(noise.data() + at, &next, std::min(sizeof next, size - at));
  }
  return noise;
}

void put_data(Json& msg, std::string data, const Style& style) {
  if (style.gzip_data) {
    msg["compression"] = "gzip";
    data = deflated(data);
  }
  if (style.cbor) {
    msg["data"] = Json::binary({data.begin(), data.end()});
  } else {
    msg["data"] = base64(data);
  }
}

std::string data_in(const Json& msg) {
  const auto& bytes = msg.at("data").get_binary();
  std::string data(bytes.begin(), bytes.end());
  return msg.value("compression", "none") == "gzip" ? inflated(data) : data;
}

std::string cells_of(std::int64_t serial, const Extent& extent) {
  std::string cells;
  for (int row = 0; row < extent.height; ++row) {
    for (int column = 0; column < extent.width; ++column)
      cells += static_cast<char>(value_of(
          serial, {extent.cell, extent.x + extent.cell * column, extent.y + extent.cell * row, 1, 1}));
  }
  return cells;
}

/// Only the serial, so that the grid is recognised wherever it goes.
std::string bad_cells(std::int64_t serial, const Extent& extent) {
  std::string cells(static_cast<std::size_t>(extent.width) * static_cast<std::size_t>(extent.height), '\0');
  for (std::size_t i = kSerialCells; i-- > 0; serial /= 100) cells[i] = static_cast<char>(serial % 100);
  return cells;
}

/// The serial of a bad grid; 0 for any other grid.
std::int64_t bad_serial_in(const std::string& cells) {
  if (cells.size() <= kSerialCells || cells.find_first_not_of('\0', kSerialCells) != std::string::npos)
    return 0;
  std::int64_t serial = 0;
  for (std::size_t i = 0; i < kSerialCells; ++i) serial = serial * 100 + cells[i];
  return serial;
}

Json grid(const Item& item, const Style& style) {
  const Extent extent = Extent::from(item.says);
  std::string cells =
      item.serial < kBadSerials ? cells_of(item.serial, extent) : bad_cells(item.serial, extent);
  Json origin = pose_at(extent.x / 1000.0, extent.y / 1000.0, style);
  origin["position"]["z"] = extent.z / 1000.0;
  if (extent.z != 0) origin["orientation"]["z"] = static_cast<double>(item.serial % 3) * 1e-9;
  Json msg = {{"header", header_of(item.stamp)},
              {"info",
               {{"resolution", extent.cell / 1000.0},
                {"width", extent.width},
                {"height", extent.height},
                {"origin", std::move(origin)}}}};
  put_data(msg, std::move(cells), style);
  return msg;
}

Json field(const char* name, std::size_t offset, int datatype = 7, std::size_t count = 1) {
  return {{"name", name}, {"offset", offset}, {"datatype", datatype}, {"count", count}};
}

std::size_t step_of(const Style& style) {
  return static_cast<std::size_t>(style.point_step) + style.noise;
}

/// Organises the points in rows of kRowWidth. The last points may be invalid, and padding looks like one
/// more point.
void organise(Json& msg, std::string& points, const Style& style) {
  const std::size_t step = step_of(style), row = kRowWidth * step;
  const auto add = [&](std::string& bytes, float x) {
    const std::size_t at = bytes.size();
    bytes.resize(at + step);
    put(bytes, at, x, style.big_endian);
  };
  while (points.size() % row != 0) add(points, std::numeric_limits<float>::quiet_NaN());
  std::string padded;
  for (std::size_t at = 0; at < points.size(); at += row) {
    padded += points.substr(at, row);
    add(padded, 1);
  }
  msg["width"] = kRowWidth;
  msg["height"] = points.size() / row;
  msg["row_step"] = row + step;
  points = std::move(padded);
}

/// In a third of the clouds an invalid point comes before each kInvalidEvery valid ones.
Json cloud(const std::vector<Item>& items, const Style& style) {
  const std::size_t step = step_of(style);
  std::string points;
  const auto add = [&](std::int64_t serial, std::array<float, 3> place, std::int64_t index) {
    const std::size_t at = points.size();
    points.resize(at + step);
    for (std::size_t i = 0; i < 3; ++i) put(points, at + 4 * i, place[i], style.big_endian);
    put(points, at + 12, static_cast<float>(serial * kPointsApart + index), style.big_endian);
    points.replace(points.size() - style.noise, style.noise, noise_of(serial, index, style.noise));
  };
  const auto add_all = [&](const Item& item) {
    for (std::int64_t index = 0; index < item.says.front(); ++index) {
      auto place = place_of(item.serial, index);
      if (item.serial % 3 == 0 && index % kInvalidEvery == 0) {
        auto invalid = place;
        invalid[static_cast<std::size_t>(item.serial / 3 % 3)] = std::numeric_limits<float>::quiet_NaN();
        add(item.serial, invalid, index);
      }
      add(item.serial, place, index);
    }
  };
  if (style.news_first) std::ranges::for_each(items, add_all);
  if (!style.news_first) std::ranges::for_each(items | std::views::reverse, add_all);
  Json msg = {{"header", header_of(items.front().stamp)},
              {"fields", {field("x", 0), field("y", 4), field("z", 8), field("intensity", 12)}},
              {"point_step", step}};
  if (style.noise > 0)
    msg["fields"].push_back(field("noise", step - style.noise, /*datatype=*/2, style.noise));
  if (style.big_endian) msg["is_bigendian"] = true;
  if (style.in_rows) organise(msg, points, style);
  put_data(msg, std::move(points), style);
  return msg;
}

Item grid_item(const Json& msg) {
  const Json& info = msg.at("info");
  const Json& origin = info.at("origin").at("position");
  const auto millimetres = [](double metres) { return static_cast<int>(std::lround(metres * 1000)); };
  const Extent extent{millimetres(info.at("resolution")),
                      millimetres(origin.at("x")),
                      millimetres(origin.at("y")),
                      info.at("width"),
                      info.at("height"),
                      millimetres(origin.at("z"))};
  const std::string cells = data_in(msg);
  Says says = extent.says();
  for (const char each : cells) says.push_back(static_cast<unsigned char>(each));
  return {.who = "", .serial = bad_serial_in(cells), .says = std::move(says)};
}

/// The number of copies of each of a cloud's points in a message.
using Copies = std::map<std::int64_t, int>;

/// Adds the clouds of that serial, as often as their points occur, in any order of points.
void add_copies(std::int64_t serial, const Copies& copies, std::vector<Item>& items) {
  for (int copy = 1;; ++copy) {
    Says says{0, 0, 0};
    for (const auto& [index, times] : copies) {
      if (times < copy) continue;
      if (++says[0] == 1) says[1] = static_cast<int>(index);
      says[2] = static_cast<int>(index);
    }
    if (says[0] == 0) return;
    items.push_back({.who = "", .serial = serial, .says = std::move(says)});
  }
}

/// The pose of the message, which clients never post. Adit never rotates a cloud.
std::array<float, 3> origin_of(const Json& msg) {
  if (!msg.contains("origin")) return {};
  const Json& at = msg["origin"].at("position");
  return {at.at("x").get<float>(), at.at("y").get<float>(), at.at("z").get<float>()};
}

/// The clouds of a message, by serial.
std::vector<Item> cloud_items(const Json& msg) {
  const std::string data = data_in(msg);
  const auto step = msg.at("point_step").get<std::size_t>();
  const bool big_endian = msg.value("is_bigendian", false);
  const auto find = [&](const char* name) {
    return std::ranges::find_if(msg.at("fields"), [&](const Json& each) { return each.at("name") == name; });
  };
  const auto offset_of = [&](const char* name) { return find(name)->at("offset").get<std::size_t>(); };
  const std::size_t x = offset_of("x"), y = offset_of("y"), z = offset_of("z");
  const std::size_t intensity = offset_of("intensity");
  const auto noise = find("noise");
  const bool is_noisy = noise != msg.at("fields").end();
  const auto origin = origin_of(msg);
  std::map<std::int64_t, Copies> clouds;
  bool strange = data.size() % step != 0;
  for (std::size_t at = 0; at + step <= data.size(); at += step) {
    const auto number = static_cast<std::int64_t>(get(data, at + intensity, big_endian));
    const std::int64_t serial = number / kPointsApart, index = number % kPointsApart;
    const auto place = place_of(serial, index);
    const auto is_at = [&](std::size_t offset, float from, float where) {
      return std::abs(get(data, at + offset, big_endian) + from - where) <= kPacking;
    };
    strange = strange || !is_at(x, origin[0], place[0]) || !is_at(y, origin[1], place[1]) ||
              !is_at(z, origin[2], place[2]);
    if (is_noisy) {
      const std::string there = noise_of(serial, index, noise->at("count").get<std::size_t>());
      strange =
          strange || data.compare(at + noise->at("offset").get<std::size_t>(), there.size(), there) != 0;
    }
    ++clouds[serial][index];
  }
  std::vector<Item> items;
  for (const auto& [serial, copies] : clouds) add_copies(serial, copies, items);
  if (strange) items.push_back({.who = "", .says = {kStrange}});
  return items;
}

}  // namespace

int value_of(std::int64_t serial, const Extent& cell) {
  constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15u;
  const auto halves = [half = cell.cell / 2](int at) { return (at - (at < 0 ? half - 1 : 0)) / half; };
  auto mixed = static_cast<std::uint64_t>(serial) * kOdd;
  for (const int each : {halves(cell.x), halves(cell.y)})
    mixed = (mixed ^ (mixed >> 29) ^ static_cast<std::uint64_t>(each + 1000)) * kOdd;
  const auto value = static_cast<int>((mixed >> 40) % 102);
  return value > 100 ? 255 : value;
}

Json header_of(double stamp) {
  Json header = {{"frame_id", "darpa"}};
  if (stamp != 0) header["stamp"] = stamp;
  return header;
}

double stamp_of(const Json& message) {
  return message.contains("header") ? message["header"].value("stamp", 0.0) : 0.0;
}

Json pose_at(double x, double y, const Style& style) {
  return {{"position", {{"x", x}, {"y", y}, {"z", 0.0}}},
          {"orientation", {{"x", 0.0}, {"y", 0.0}, {"z", 0.0}, {"w", style.quaternion}}}};
}

Json map_of(const std::vector<Item>& items, const Style& style) {
  const Item& item = items.front();
  const bool is_of_cells = is_grid(item.says);
  Json message = {{"type", is_of_cells ? "OccupancyGrid" : "PointCloud2"},
                  {"msg", is_of_cells ? grid(item, style) : cloud(items, style)}};
  if (!item.who.empty()) message["name"] = item.who;
  return message;
}

std::vector<Item> map_items(const Json& message) {
  const Json& msg = message.at("msg");
  const bool is_of_cells = message.at("type") == "OccupancyGrid";
  std::vector<Item> items = is_of_cells ? std::vector{grid_item(msg)} : cloud_items(msg);
  for (Item& item : items) {
    item.who = message.value("name", "");
    item.stamp = stamp_of(msg);
  }
  return items;
}

}  // namespace adit::simulation
