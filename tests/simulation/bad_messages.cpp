#include "simulation/bad_messages.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include "simulation/http.hpp"
#include "simulation/map_messages.hpp"
#include "simulation/messages.hpp"

namespace adit::simulation {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr const char* kRight = "Bearer token-of-the-team";

/// A valid message of each kind, before a fault is put into it.
Posting good(std::string_view kind, std::int64_t serial) {
  if (kind == "report") return {kReports, {{.who = "", .serial = serial}}};
  if (kind == "pose") return {kState, {{.who = "bad", .serial = serial}}};
  if (kind == "marker") return {kMarkers, {{.who = "bad", .serial = serial, .says = {kAdd, 1, 0}}}};
  if (kind == "cloud") return {kMap, {{.who = "bad", .serial = serial, .says = {20}}}};
  return {kMap, {{.who = "bad", .serial = serial, .says = Extent{}.says()}}};
}

/// A fault inside a message: 422, "incorrect information for this interaction type".
struct Spoilt {
  const char* what;
  const char* kind;
  void (*spoil)(Json& message);
  bool cbor_only = false;  // JSON cannot express it
};

const std::vector<Spoilt>& all_spoilt() {
  static const std::vector<Spoilt> all{
      {"a type that is none of the ten", "report", [](Json& m) { m["type"] = "Sponge"; }},
      {"a report without its x", "report", [](Json& m) { m.erase("x"); }},
      {"a report without its type", "report", [](Json& m) { m.erase("type"); }},
      {"an x that is text", "report", [](Json& m) { m["x"] = "1"; }},
      {"a report that is a list", "report", [](Json& m) { m = Json::array({m}); }},
      {"another frame", "pose", [](Json& m) { m["header"]["frame_id"] = "odom"; }},
      {"no poses", "pose", [](Json& m) { m.erase("poses"); }},
      {"a pose without its position", "pose", [](Json& m) { m["poses"][0].erase("position"); }},
      {"a pose without a name", "pose", [](Json& m) { m["poses"][0].erase("name"); }},
      {"a pose that is no number", "pose", [](Json& m) { m["poses"][0]["position"]["y"] = kNaN; }, true},
      {"a pose at infinity", "pose", [](Json& m) { m["poses"][0]["position"]["z"] = kInfinity; }, true},
      {"a type that is no map", "grid", [](Json& m) { m["type"] = "OctoMap"; }},
      {"a map without msg", "grid", [](Json& m) { m.erase("msg"); }},
      {"fewer cells than it says", "grid", [](Json& m) { m["msg"]["info"]["width"] = 9; }},
      {"a cell of 101", "grid", [](Json& m) { m["msg"]["data"].get_binary()[7] = 101; }, true},
      {"cells of no size", "grid", [](Json& m) { m["msg"]["info"]["resolution"] = 0.0; }},
      {"cells of infinite size", "grid", [](Json& m) { m["msg"]["info"]["resolution"] = kInfinity; }, true},
      {"cells larger than a float32", "grid", [](Json& m) { m["msg"]["info"]["resolution"] = 1e39; }},
      {"cells smaller than a float32", "grid", [](Json& m) { m["msg"]["info"]["resolution"] = 1e-50; }},
      {"an unknown compression", "grid", [](Json& m) { m["msg"]["compression"] = "zip"; }},
      {"gzip that is none", "grid", [](Json& m) { m["msg"]["compression"] = "gzip"; }},
      {"a grid without info", "grid", [](Json& m) { m["msg"].erase("info"); }},
      {"a map's other frame", "grid", [](Json& m) { m["msg"]["header"]["frame_id"] = "map"; }},
      {"points without y", "cloud", [](Json& m) { m["msg"]["fields"][1]["name"] = "why"; }},
      {"a datatype of 9", "cloud", [](Json& m) { m["msg"]["fields"][3]["datatype"] = 9; }},
      {"a field beyond its point", "cloud", [](Json& m) { m["msg"]["fields"][3]["offset"] = 13; }},
      {"half a point", "cloud", [](Json& m) { m["msg"]["point_step"] = 17; }},
      {"points of no size", "cloud", [](Json& m) { m["msg"]["point_step"] = 0; }},
      {"an action of 7", "marker", [](Json& m) { m["markers"][0]["action"] = 7; }},
      {"a marker without scale", "marker", [](Json& m) { m["markers"][0].erase("scale"); }},
      {"a marker without pose", "marker", [](Json& m) { m["markers"][0].erase("pose"); }},
      {"a marker redder than red", "marker", [](Json& m) { m["markers"][0]["color"]["r"] = 1.5; }},
      {"a scale that is no number", "marker", [](Json& m) { m["markers"][0]["scale"]["y"] = kNaN; }, true},
      {"a lifetime longer than ROS has", "marker", [](Json& m) { m["markers"][0]["lifetime"] = 3e9; }},
      {"a stamp later than ROS has", "pose", [](Json& m) { m["header"]["stamp"] = 1e10; }},
      {"a marker's other frame", "marker", [](Json& m) { m["markers"][0]["header"]["frame_id"] = "odom"; }},
  };
  return all;
}

std::string bytes_of(const Json& message, bool cbor) {
  if (!cbor) return message.dump();
  const auto bytes = Json::to_cbor(message);
  return {bytes.begin(), bytes.end()};
}

std::string post(const std::string& path, const std::string& body, const char* type, const char* token,
                 const std::string& more = "") {
  const std::string authorization = *token == '\0' ? "" : std::string("Authorization: ") + token + "\r\n";
  return http_request("POST", path,
                      "Host: 10.0.0.1\r\n" + authorization + "Content-Type: " + type + "\r\n" + more, body);
}

constexpr const char *kJsonType = "application/json", *kCborType = "application/cbor";

BadMessage spoilt(Random& random, std::int64_t serial) {
  const Spoilt& chosen = all_spoilt()[random.uniform_index(all_spoilt().size())];
  const Posting posting = good(chosen.kind, serial);
  const bool cbor = chosen.cbor_only || (posting.path != kReports && random.chance(0.5));
  Json message = message_of(posting, {.cbor = cbor});
  chosen.spoil(message);
  return {chosen.what, posting.path, 422,
          post(posting.path, bytes_of(message, cbor), cbor ? kCborType : kJsonType, kRight)};
}

/// A fault outside the message: its path, method, headers or encoding.
BadMessage misposted(Random& random, std::int64_t serial) {
  constexpr const char* kKinds[] = {"report", "pose", "marker", "cloud", "grid"};
  const Posting posting = good(kKinds[random.uniform_index(std::size(kKinds))], serial);
  const std::string& path = posting.path;
  const std::string json = bytes_of(message_of(posting, {}), false);
  const std::string cbor = bytes_of(message_of(posting, {.cbor = true}), true);
  switch (random.uniform_index(9)) {
    case 0:
      return {"a wrong token", path, 401, post(path, json, kJsonType, "Bearer token-of-another")};
    case 1:
      return {"no token", path, 401, post(path, json, kJsonType, "")};
    case 2:
      return {"JSON that ends early", path, 400,
              post(path, json.substr(0, 1 + random.uniform_index(json.size() - 1)), kJsonType, kRight)};
    case 3:
      return {"JSON that goes on", path, 400, post(path, json + "}", kJsonType, kRight)};
    case 4:
      if (path == kReports) return {"CBOR for a report", path, 422, post(path, cbor, kCborType, kRight)};
      return {"CBOR that ends early", path, 400,
              post(path, cbor.substr(0, 1 + random.uniform_index(cbor.size() - 1)), kCborType, kRight)};
    case 5:
      return {"text", path, 422, post(path, json, "text/plain", kRight)};
    case 6:
      return {"an unknown coding", path, 422,
              post(path, json, kJsonType, kRight, "Content-Encoding: br\r\n")};
    case 7:
      return {"an unknown path", path + "s", 404, post(path + "s", json, kJsonType, kRight)};
    default:
      return {"a number that JSON has not", path, 400,
              post(path, "{\"x\": NaN, " + json.substr(1), kJsonType, kRight)};
  }
}

}  // namespace

BadMessage bad_message(Random& random, std::int64_t serial) {
  return random.chance(0.6) ? spoilt(random, serial) : misposted(random, serial);
}

}  // namespace adit::simulation
