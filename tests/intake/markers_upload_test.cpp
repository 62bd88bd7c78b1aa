#include <gtest/gtest.h>

#include <chrono>

#include "codec/deflated.hpp"
#include "icd/mapping.hpp"
#include "intake/team.hpp"
#include "intake/uploads.hpp"

namespace adit::intake {
namespace {

using codec::test::gzipped;
using nlohmann::json;

constexpr double kFar = 1000.0 / 7;  // many digits
const json kPoint = {{"x", kFar}, {"y", -kFar}, {"z", 0.3}};
const json kColor = {{"r", 0.1}, {"g", 0.2}, {"b", 0.3}, {"a", 0.9}};

json marker(const json& points) {
  return {{"ns", "voxels"},
          {"id", 1},
          {"type", 6},
          {"action", 0},
          {"pose",
           {{"position", {{"x", 0}, {"y", 0}, {"z", 0}}},
            {"orientation", {{"x", 0}, {"y", 0}, {"z", 0}, {"w", 1}}}}},
          {"scale", {{"x", 0.1}, {"y", 0.1}, {"z", 0.1}}},
          {"color", {{"r", 0}, {"g", 0}, {"b", 1}, {"a", 1}}},
          {"points", points}};
}

std::string cbor_of(const json& message) {
  std::string bytes;
  json::to_cbor(message, bytes);
  return bytes;
}

/// A CBOR list of `count` copies of `one`. Encoding JSON values would take too long.
std::string list_of(std::uint32_t count, const json& one) {
  std::string list = "\x9a";  // an array with a length of four bytes
  for (const int shift : {24, 16, 8, 0}) list += static_cast<char>(count >> shift & 0xff);
  const std::string bytes = cbor_of(one);
  list.reserve(list.size() + count * bytes.size());
  for (std::uint32_t n = 0; n < count; ++n) list += bytes;
  return list;
}

/// Replaces the value of the member `name`, which is its name, by `list`.
std::string put(std::string cbor, const std::string& name, const std::string& list) {
  const std::string text = cbor_of(name);
  return cbor.replace(cbor.find(text + text) + text.size(), text.size(), list);
}

std::string message_of(std::uint32_t points) {
  return put(cbor_of({{"markers", {marker("points")}}}), "points", list_of(points, kPoint));
}

/// The message handler accepts a message with the largest marker.
void expect_accepted(std::string_view headers, const std::string& body, bool colored) {
  Team team;
  const auto reply =
      team.ask(authorized("POST", "/markers/update", headers, body), std::chrono::seconds(100));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 200) << reply->body;
  team.served.on_loop([&] {
    ASSERT_EQ(team.message_handler.markers.size(), 1u);
    ASSERT_EQ(team.message_handler.markers[0].markers.size(), 1u);
    const icd::Marker& taken = team.message_handler.markers[0].markers[0];
    EXPECT_EQ(taken.points.size(), icd::kMostMarkerPoints);
    EXPECT_EQ(taken.points.at(70).x, kFar);
    EXPECT_EQ(taken.colors.size(), colored ? icd::kMostMarkerPoints : 0);
    EXPECT_EQ(team.message_handler.senders.at(0).bytes, body.size());
  });
}

TEST(MarkersUpload, HasRoomForTheLargestMarkerUnderGzip) {
  json colored = marker("points");
  colored["colors"] = "colors";
  const std::string points =
      put(cbor_of({{"markers", {colored}}}), "points", list_of(icd::kMostMarkerPoints, kPoint));
  const std::string cbor = put(points, "colors", list_of(icd::kMostMarkerPoints, kColor));
  EXPECT_GT(cbor.size(), 7u << 20);
  expect_accepted(std::string(kCborType) + kGzip, gzipped(cbor), true);
}

TEST(MarkersUpload, HasRoomForTheLargestMarkerInJson) {
  const std::string one = kPoint.dump(), member = R"("points":)";
  std::string list = "[" + one;
  for (std::size_t n = 1; n < icd::kMostMarkerPoints; ++n) list.append(",").append(one);
  std::string text = json{{"markers", {marker("points")}}}.dump();
  text.replace(text.find(member) + member.size(), sizeof "points" + 1, list + "]");
  ASSERT_GT(text.size(), 5u << 20);
  expect_accepted(kJsonType, text, false);
}

TEST(MarkersUpload, IsRejectedAboveItsLimit) {
  Team team;
  const std::string head = std::string(kJsonType) + "Content-Length: 8388609\r\n";
  EXPECT_EQ(team.ask(authorized("POST", "/markers/update", head))->body,
            "\"Content-Length: expected at most 8388608, got 8388609\"");
  const std::string blanks = "{\"markers\": [" + std::string(MarkersUpload::kMost, ' ') + "]}";
  const auto reply =
      team.ask(authorized("POST", "/markers/update", std::string(kJsonType) + kGzip, gzipped(blanks)));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 413) << reply->body;
  EXPECT_EQ(team.served.on_loop([&] { return team.message_handler.refusals.size(); }), 2u);
}

TEST(MarkersUpload, NeedsAWorkerOnlyIfItIsLarge) {
  Team team;
  Team::Busy busy(team);
  const std::string bodies[] = {message_of(2'000), message_of(50'000)};
  RawClient middling(team.served.port()), large(team.served.port());  // each has 5 s to authenticate
  middling.send(authorized("POST", "/markers/update", kCborType, bodies[0]));
  large.send(authorized("POST", "/markers/update", kCborType, bodies[1]));
  EXPECT_EQ(team.ask(authorized("POST", "/markers/update", kJsonType, kMarkersBody))->status, 200);
  team.served.on_loop([&] {
    ASSERT_EQ(team.message_handler.markers.size(), 1u);
    EXPECT_EQ(team.message_handler.markers[0].markers.size(), 1u);
  });
  busy.end();
  EXPECT_EQ(middling.reply()->status, 200);
  EXPECT_EQ(large.reply()->status, 200);
}

TEST(MarkersUpload, IsAcceptedForItsGoodParts) {
  Team team;
  json markers = {marker("points"), 7, marker({kPoint, kPoint, kPoint})};
  markers[2]["id"] = 2;
  const std::string body = put(cbor_of({{"markers", markers}}), "points", list_of(40'000, kPoint));
  const auto reply = team.ask(authorized("POST", "/markers/update", kCborType, body));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 422);
  EXPECT_EQ(reply->body,
            "\"markers[1]: expected an object, got a whole number (the other 2 were accepted)\"");
  EXPECT_EQ(team.served.on_loop([&] { return team.message_handler.markers.at(0).markers.size(); }), 2u);
}

TEST(MarkersUpload, IsDroppedAfterADisconnectOrAStop) {
  Team team;
  const std::string body = message_of(50'000);
  const std::string sent = authorized("POST", "/markers/update", kCborType, body);
  Team::Busy busy(team);
  {
    RawClient gone(team.served.port());
    gone.send(sent);
    team.served.turn_often();
    gone.reset();
    ASSERT_TRUE(team.served.eventually([&] { return team.served.server().connections() == 0; }));
  }
  RawClient late(team.served.port());
  late.send(sent);
  team.served.turn_often();
  team.served.on_loop([&] { team.front.routes->stop(); });
  EXPECT_EQ(late.reply()->status, 503);
  busy.end();
  team.served.turn_often();
  team.served.on_loop([&] { EXPECT_TRUE(team.message_handler.markers.empty()); });
}

TEST(MarkersUpload, WaitsWhileAnotherIsRead) {
  Team team;
  const std::string body = message_of(50'000);
  const std::string sent = authorized("POST", "/markers/update", kCborType, body);
  Team::Busy busy(team);
  RawClient first(team.served.port()), second(team.served.port());
  first.send(sent);
  second.send(sent);
  {
    RawClient gone(team.served.port());
    gone.send(sent);
    ASSERT_TRUE(team.served.eventually([&] { return team.served.server().connections() == 3; }));
    team.served.turn_often();
    gone.reset();
    ASSERT_TRUE(team.served.eventually([&] { return team.served.server().connections() == 2; }));
  }
  EXPECT_EQ(team.ask(authorized("POST", "/markers/update", kJsonType, kMarkersBody))->status, 200);
  busy.end();
  EXPECT_EQ(first.reply()->status, 200);
  EXPECT_EQ(second.reply()->status, 200);
}

TEST(MarkersUpload, IsRejectedIfTheBudgetIsUsedUp) {
  IcdOptions options = Team::with_tokens();
  options.marker_bytes = 1'000'000;
  Team team(options);
  const std::string body = message_of(50'000);
  for (int again = 0; again < 2; ++again) {
    const auto refused = team.ask(authorized("POST", "/markers/update", kCborType, body));
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->status, 429) << refused->body;
  }
  EXPECT_EQ(team.ask(authorized("POST", "/markers/update", kJsonType, kMarkersBody))->status, 200)
      << "the budget is returned";
}

TEST(MarkersUpload, IsRejectedIfTheDeskFails) {
  Team team;
  const std::string large = message_of(50'000);
  team.served.on_loop([&] { team.message_handler.fails = true; });
  const auto reply = team.ask(authorized("POST", "/markers/update", kCborType, large));
  ASSERT_TRUE(reply) << "no answer";
  EXPECT_EQ(reply->status, 503);
  ASSERT_TRUE(team.ask(authorized("POST", "/markers/update", kJsonType, kMarkersBody)));
  team.served.on_loop([&] { team.message_handler.fails = false; });
  EXPECT_EQ(team.ask(authorized("POST", "/markers/update", kCborType, large))->status, 200);
}

/// Bodies that are short but need much memory.
TEST(MarkersUpload, IsRejectedIfItHasTooManyValues) {
  Team team;
  const auto many = [](const std::string& head, const std::string& one, const std::string& tail) {
    std::string body = head;
    for (int n = 0; n < 1'010'000 && body.size() + one.size() + tail.size() < MarkersUpload::kMost; ++n)
      body += one;
    return body + tail;
  };
  const std::string_view kChunks("\x7f\x60", 2);
  const std::string zero("\0", 1), cbor_head("\xa1\x67markers\x9f", 10);
  const std::pair<std::string_view, std::string> bodies[] = {
      {kJsonType, many("{\"markers\":[0", ",0", "]}")},
      {kJsonType, many("{\"markers\":[{}", ",{}", "]}")},
      {kJsonType, many("{\"markers\":[{\"\":0", ",\"\":0", "}]}")},
      {kCborType, many(cbor_head, zero, "\xff")},
      {kCborType, many(cbor_head, "\xa0", "\xff")},
      {kCborType, many(cbor_head + "\xbf", "\x60" + zero, "\xff\xff")},
      {kCborType, many(cbor_head + std::string(kChunks), "\x60", "\xff\xff")}};
  for (bool zipped = false; const auto& [type, body] : bodies) {
    const auto reply = team.ask(authorized(
        "POST", "/markers/update", std::string(type) + (zipped ? kGzip : ""), zipped ? gzipped(body) : body));
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 413) << reply->body;
    EXPECT_NE(reply->body.find("1000000 values"), std::string::npos) << reply->body;
    zipped = !zipped;
  }
  for (const std::string_view path : {"/state/update", "/map/update"}) {
    const auto reply = team.ask(authorized(
        "POST", path, kJsonType, "{\"poses\":[0" + std::string(bodies[0].second, 13, 300'000) + "]}"));
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 413) << reply->body;
  }
  const std::string deletes =
      many("{\"markers\":[{\"action\":2}", ",{\"action\":2}", "]}").substr(0, 24 + 13 * 110'000);
  EXPECT_EQ(team.ask(authorized("POST", "/markers/update", kJsonType, deletes + "]}"))->status, 422);
}

}  // namespace
}  // namespace adit::intake
