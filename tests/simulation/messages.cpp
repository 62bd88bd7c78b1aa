#include "simulation/messages.hpp"

#include <cmath>

#include "simulation/bytes.hpp"
#include "simulation/map_messages.hpp"
#include "simulation/scoreboard.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr std::size_t kLetters = 60'000;
constexpr double kAcross = 2.3;        // metres; not exact in float32
constexpr double kReportsApart = 100;  // metres, so that Adit does not take reports for duplicates

std::int64_t whole(double number) {
  return static_cast<std::int64_t>(std::llround(number));
}

/// The number of points of a line that is added. Other markers are cubes without points.
std::size_t points_of(const Item& item) {
  return item.says[0] == kAdd && item.who.ends_with(kPath) ? 2 + static_cast<std::size_t>(item.serial % 5)
                                                           : 0;
}

/// The length of a marker's text. Some texts are very long.
std::size_t letters_of(const Item& item) {
  return item.says[0] == kAdd && item.who.ends_with(kWriting) ? kLetters : 0;
}

int type_of(const Item& item) {
  constexpr int kCube = 1, kLine = 4, kText = 9;
  return points_of(item) > 0 ? kLine : letters_of(item) > 0 ? kText : kCube;
}

/// The robot that a report names; "" for the operator's reports, which name none.
std::string reporter_of(std::int64_t serial) {
  const std::int64_t posted = serial % kCorrections;  // a correction keeps the robot
  return posted < kOwnReports && posted % 3 == 0 ? "R1" : "";
}

Json report_of(std::int64_t serial, const Style& style) {
  Json report = {{"x", static_cast<double>(serial) * kReportsApart},
                 {"y", style.rounds ? static_cast<double>(static_cast<float>(kAcross)) : kAcross},
                 {"z", -1.0},
                 {"type", serial % 2 == 0 ? "Drill" : "Rope"}};
  if (const std::string name = reporter_of(serial); !name.empty()) report["name"] = name;
  return report;
}

/// A report with a missing or another robot becomes kStrange.
Item report_item(const Json& report) {
  const std::int64_t serial = whole(report.value("x", 0.0) / kReportsApart);
  return {.who = "", .serial = report.value("name", "") == reporter_of(serial) ? serial : kStrange};
}

Json marker_of(const Item& item, const Style& style) {
  Json points = Json::array();
  for (std::size_t i = 0; i < points_of(item); ++i)
    points.push_back({{"x", 0.1 * static_cast<double>(i)}, {"y", 1.0}, {"z", 0.0}});
  Json marker = {{"header", header_of(item.stamp)},
                 {"ns", item.who},
                 {"id", item.says[1]},
                 {"type", type_of(item)},
                 {"points", std::move(points)},
                 {"text", std::string(letters_of(item), 'x')},
                 {"action", item.says[0]},
                 {"pose", pose_at(0, 1, style)},
                 {"scale", {{"x", static_cast<double>(item.serial)}, {"y", 1.0}, {"z", 1.0}}},
                 {"lifetime", item.says[2] / 1000.0},
                 {"color", {{"r", 1.0}, {"g", 0.0}, {"b", 0.0}, {"a", 1.0}}}};
  if (item.who.empty() && item.serial % 2 == 0) marker.erase("ns");
  return marker;
}

/// A marker that has lost points or letters becomes kStrange.
Item marker_item(const Json& marker) {
  Item item{.who = marker.value("ns", ""),
            .serial = whole(marker.at("scale").at("x")),
            .stamp = stamp_of(marker),
            .says = {marker.at("action"), marker.value("id", 0),
                     static_cast<int>(whole(1000 * marker.value("lifetime", 0.0)))}};
  const std::size_t points = marker.contains("points") ? marker.at("points").size() : 0;
  const bool is_whole = points == points_of(item) && marker.value("text", "").size() == letters_of(item);
  if (!is_whole) item.serial = kStrange;
  return item;
}

}  // namespace

Json message_of(const Posting& posting, const Style& style) {
  const Item& item = posting.items.front();
  if (posting.path == kReports) return report_of(item.serial, style);
  if (posting.path == kMap) return map_of(posting.items, style);
  if (posting.path == kState) {
    Json poses = Json::array();
    for (const Item& each : posting.items) {
      poses.push_back(pose_at(static_cast<double>(each.serial), 1, style));
      poses.back()["name"] = each.who;
    }
    return {{"header", header_of(item.stamp)}, {"poses", std::move(poses)}};
  }
  Json markers = Json::array();
  for (const Item& each : posting.items) markers.push_back(marker_of(each, style));
  return {{"markers", std::move(markers)}};
}

std::vector<Item> items_of(const HttpMessage& request) {
  std::vector<Item> items;
  const std::string path = request.path();
  if (path == kStatus) return items;
  const bool cbor = request.header("content-type") == "application/cbor";
  const Json message =
      cbor ? Json::from_cbor(request.body, true, false) : Json::parse(request.body, nullptr, false);
  if (!message.is_object()) return items;
  if (path == kReports) items.push_back(report_item(message));
  if (path == kState) {
    for (const Json& named : message.at("poses"))
      items.push_back({named.at("name"), whole(named.at("position").at("x")), stamp_of(message)});
  }
  if (path == kMarkers) {
    for (const Json& marker : message.at("markers")) items.push_back(marker_item(marker));
  }
  return path == kMap ? map_items(message) : items;
}

std::vector<Event> events_of(const Posting& posting) {
  std::vector<Event> events;
  events.reserve(posting.items.size());
  for (const Item& item : posting.items) {
    events.push_back({.what = posting.path,
                      .who = item.who,
                      .serial = item.serial,
                      .stamp = item.stamp,
                      .says = item.says});
  }
  return events;
}

Says status_in(const std::string& body) {
  const Json status = Json::parse(body, nullptr, false);
  const auto is_number = [&](const char* name) {
    return status.contains(name) && status.at(name).is_number();
  };
  if (!status.is_object() || !is_number("score") || !is_number("remaining_reports") ||
      !is_number("run_clock"))
    return {};
  return {status["score"], status.at("remaining_reports"),
          static_cast<int>(std::lround(status.at("run_clock").get<double>() * 1000))};
}

Says reply_in(const std::string& body) {
  const Json reply = Json::parse(body, nullptr, false);
  if (!reply.is_object() || !reply.value("score_change", Json()).is_number_integer() ||
      !reply.value("report_status", Json()).is_string())
    return {};
  return {static_cast<int>(report_item(reply).serial), reply.at("report_status") == kScored ? 1 : 0,
          reply.at("score_change"), static_cast<int>(std::lround(reply.value("run_clock", 0.0) * 1000))};
}

std::string request_of(const Posting& posting, const Style& style) {
  Style used = style;
  used.cbor = style.cbor && posting.path != kReports;
  if (posting.path == kMap) World::current().posted_maps.push_back(posting.items);
  const Json message = message_of(posting, used);
  std::string body;
  if (used.cbor) {
    Json::to_cbor(message, body);
  } else {
    body = message.dump();
  }
  std::string headers =
      std::string("Host: 10.0.0.1\r\nAuthorization: Bearer token-of-the-team\r\nContent-Type: ") +
      (used.cbor ? "application/cbor" : "application/json") + "\r\n";
  if (style.gzip) {
    body = deflated(body);
    headers += "Content-Encoding: gzip\r\n";
  }
  return http_request("POST", posting.path, headers, body);
}

}  // namespace adit::simulation
