#include "simulation/messages.hpp"

#include <zlib.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace adit::simulation {
namespace {

using Json = nlohmann::json;

constexpr double kReportsApart = 100;  // metres, so that none is near another
constexpr int kSerialCells = 4;        // of a grid, each a digit of base 100

std::string deflated(const std::string& bytes) {
  z_stream stream{};
  if (deflateInit2(&stream, 3, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK) std::abort();
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) std::abort();
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

std::string inflated(const std::string& bytes) {
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 32) != Z_OK) std::abort();
  std::string out(1 << 20, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int result = inflate(&stream, Z_FINISH);
  out.resize(result == Z_STREAM_END ? stream.total_out : 0);
  inflateEnd(&stream);
  return out;
}

std::string base64(const std::string& bytes) {
  constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t j = 0; j < 3; ++j)
      three = three << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0);
    for (std::size_t j = 0; j < 4; ++j)
      text += i + j <= bytes.size() ? kLetters[three >> (18 - 6 * j) & 63] : '=';
  }
  return text;
}

double stamp_of(const Json& message) {
  return message.contains("header") ? message["header"].value("stamp", 0.0) : 0.0;
}

std::int64_t whole(double number) {
  return static_cast<std::int64_t>(std::llround(number));
}

std::int64_t serial_of(const Json& grid) {
  const auto& bytes = grid["data"].get_binary();
  std::string cells(bytes.begin(), bytes.end());
  if (grid.value("compression", "none") == "gzip") cells = inflated(cells);
  std::int64_t serial = 0;
  for (int i = 0; i < kSerialCells; ++i)
    serial =
        serial * 100 + (cells.size() > static_cast<std::size_t>(i) ? cells[static_cast<std::size_t>(i)] : 0);
  return serial;
}

Json pose(double x) {
  return {{"position", {{"x", x}, {"y", 1.0}, {"z", 0.0}}},
          {"orientation", {{"x", 0.0}, {"y", 0.0}, {"z", 0.0}, {"w", 1.0}}}};
}

Json header(double stamp) {
  Json header = {{"frame_id", "darpa"}};
  if (stamp != 0) header["stamp"] = stamp;
  return header;
}

Json grid(const Posting& posting, const Style& style) {
  std::string cells(static_cast<std::size_t>(posting.size) * static_cast<std::size_t>(posting.size), '\0');
  std::int64_t serial = posting.serial;
  for (std::size_t i = kSerialCells; i-- > 0; serial /= 100) cells[i] = static_cast<char>(serial % 100);
  Json message = {
      {"header", header(posting.stamp)},
      {"info",
       {{"resolution", 0.5}, {"width", posting.size}, {"height", posting.size}, {"origin", pose(0)}}}};
  if (style.gzip_data) {
    message["compression"] = "gzip";
    cells = deflated(cells);
  }
  if (style.cbor) {
    message["data"] = Json::binary({cells.begin(), cells.end()});
  } else {
    message["data"] = base64(cells);
  }
  return {{"type", "OccupancyGrid"}, {"name", posting.who}, {"msg", std::move(message)}};
}

Json message_of(const Posting& posting, const Style& style) {
  const auto serial = static_cast<double>(posting.serial);
  if (posting.path == kReports) {
    return {{"x", serial * kReportsApart},
            {"y", 2.5},
            {"z", -1.0},
            {"type", posting.serial % 2 == 0 ? "Drill" : "Rope"}};
  }
  if (posting.path == kMap) return grid(posting, style);
  if (posting.path == kState) {
    Json named = pose(serial);
    named["name"] = posting.who;
    return {{"header", header(posting.stamp)}, {"poses", Json::array({named})}};
  }
  Json marker = {{"header", header(posting.stamp)},
                 {"ns", posting.who},
                 {"id", 1},
                 {"type", 1},
                 {"action", 0},
                 {"pose", pose(0)},
                 {"scale", {{"x", serial}, {"y", 1.0}, {"z", 1.0}}},
                 {"color", {{"r", 1.0}, {"g", 0.0}, {"b", 0.0}, {"a", 1.0}}}};
  return {{"markers", Json::array({marker})}};
}

}  // namespace

std::vector<Item> items_of(const HttpMessage& request) {
  std::vector<Item> items;
  const std::string path = request.path();
  if (path == kStatus) return items;
  const bool cbor = request.header("content-type") == "application/cbor";
  const Json message =
      cbor ? Json::from_cbor(request.body, true, false) : Json::parse(request.body, nullptr, false);
  if (!message.is_object()) return items;
  if (path == kReports)
    items.push_back({.who = "", .serial = whole(message.value("x", 0.0) / kReportsApart)});
  if (path == kState) {
    for (const Json& named : message.at("poses"))
      items.push_back({named.at("name"), whole(named.at("position").at("x")), stamp_of(message)});
  }
  if (path == kMarkers) {
    for (const Json& marker : message.at("markers"))
      items.push_back({marker.value("ns", ""), whole(marker.at("scale").at("x")), stamp_of(marker)});
  }
  if (path == kMap)
    items.push_back({message.value("name", ""), serial_of(message.at("msg")), stamp_of(message.at("msg"))});
  return items;
}

std::string request_of(const Posting& posting, const Style& style) {
  const bool cbor = style.cbor && posting.path != kReports;
  const Json message = message_of(posting, {.cbor = cbor, .gzip_data = style.gzip_data});
  std::string body = message.dump();
  if (cbor) {
    const auto bytes = Json::to_cbor(message);
    body.assign(bytes.begin(), bytes.end());
  }
  std::string headers =
      std::string("Host: 10.0.0.1\r\nAuthorization: Bearer token-of-the-team\r\nContent-Type: ") +
      (cbor ? "application/cbor" : "application/json") + "\r\n";
  if (style.gzip) {
    body = deflated(body);
    headers += "Content-Encoding: gzip\r\n";
  }
  return http_request("POST", posting.path, headers, body);
}

}  // namespace adit::simulation
