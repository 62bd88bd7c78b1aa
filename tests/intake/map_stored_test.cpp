// The message handler stores a map's data as it arrives.
#include <gtest/gtest.h>

#include "codec/body_decoder.hpp"
#include "codec/deflated.hpp"
#include "codec/read.hpp"
#include "intake/team.hpp"
#include "intake/uploads.hpp"

namespace adit::intake {
namespace {

using codec::test::gzipped;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// The message handler has one map, equal to the decoded `body`.
void expect_the_map_of(Team& team, const std::string& body) {
  auto document =
      codec::decode({codec::Format::Json, codec::ContentCoding::Identity}, codec::Split::MapData, body);
  const icd::MapUpdate map = codec::read_map_update(std::move(*document), {}).value();
  team.served.on_loop([&] {
    ASSERT_EQ(team.message_handler.maps.size(), 1u);
    EXPECT_TRUE(team.message_handler.maps[0] == map) << "other points";
  });
}

TEST(MapUpload, IsStoredAsItArrives) {
  for (const std::string& body : {cloud_body(200'000), grid_with_late_type(2000, 1000)}) {
    Team team;
    RawClient client(team.served.port());
    client.send(map_head(body) + body.substr(0, body.size() / 2));
    EXPECT_TRUE(team.served.eventually([&] { return team.message_handler.stored > body.size() / 4; }));
    EXPECT_EQ(team.served.on_loop([&] { return team.message_handler.arriving; }), 1);
    client.send(body.substr(body.size() / 2));
    EXPECT_EQ(client.reply()->status, 200);
    expect_the_map_of(team, body);
    EXPECT_TRUE(team.served.eventually([&] { return team.message_handler.arriving == 0; }));
  }
}

TEST(MapUpload, CompressesAGridAsItArrives) {
  for (const bool is_compressed : {false, true}) {
    Team team;
    const std::string body = grid_body(1500, 1500);
    const std::string sent = is_compressed ? gzipped(body) : body;
    const auto reply = team.ask(map_head(sent, is_compressed ? kGzip : "") + sent);
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 200) << reply->body;
    expect_the_map_of(team, body);
    EXPECT_EQ(team.served.on_loop([&] { return team.message_handler.stored; }), 0u) << "uncompressed cells";
  }
}

TEST(MapUpload, DelaysTheClientWhileNothingCanBeStored) {
  Team team;
  team.served.on_loop([&] { team.message_handler.stores_pieces = false; });
  const std::string body = cloud_body(1'300'000);
  RawClient client(team.served.port());
  client.send(map_head(body));
  const std::size_t sent = client.send_until_stalled(body, milliseconds(500));
  EXPECT_LT(sent, body.size()) << "the server must not buffer the body";
  EXPECT_EQ(team.served.on_loop([&] { return team.message_handler.storing.size(); }), 1u);
  team.served.on_loop([&] {
    team.message_handler.stores_pieces = true;
    team.message_handler.storing.front()();
  });
  client.send(std::string_view(body).substr(sent));
  const auto reply = client.reply(seconds(30));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 200) << reply->body;
  expect_the_map_of(team, body);
}

TEST(MapUpload, StaysInMemoryIfThereIsNoRoomOnDisk) {
  for (const std::size_t room : {std::size_t{0}, std::size_t{500'000}}) {
    Team team;
    team.served.on_loop([&] { team.message_handler.room = room; });
    const std::string body = cloud_body(200'000);
    EXPECT_EQ(team.ask(authorized("POST", "/map/update", kJsonType, body))->status, 200);
    expect_the_map_of(team, body);
    EXPECT_LE(team.served.on_loop([&] { return team.message_handler.stored; }), room);
  }
}

TEST(MapUpload, StoresNoPartOfASmallMap) {
  Team team;
  EXPECT_EQ(team.ask(authorized("POST", "/map/update", kJsonType, cloud_body(1000)))->status, 200);
  EXPECT_EQ(team.served.on_loop([&] { return team.message_handler.stored; }), 0u);
}

TEST(MapUpload, StoresACompressedMapAsItIsInflated) {
  Team team;
  team.served.on_loop([&] { team.message_handler.stores_pieces = false; });
  const std::string body = cloud_body(300'000);
  const std::string sent = gzipped(body);
  RawClient client(team.served.port());
  client.send(map_head(sent, kGzip) + sent);
  ASSERT_TRUE(team.served.eventually([&] { return team.message_handler.storing.size() == 1; }));
  team.served.turn_often();
  EXPECT_LT(team.served.on_loop([&] { return team.message_handler.stored; }), 2 * MapUpload::kStored);
  team.served.on_loop([&] {
    team.message_handler.stores_pieces = true;
    team.message_handler.storing.front()();
  });
  const auto reply = client.reply(seconds(30));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 200) << reply->body;
  expect_the_map_of(team, body);
}

TEST(MapUpload, IsRejectedIfItNeedsTooMuchMemory) {
  Team team;
  team.served.on_loop([&] { team.message_handler.room = 1'000'000; });
  const std::string sent = gzipped(cloud_body(2'400'000));
  ASSERT_GT(12u * 2'400'000u, MapUpload::kWithoutRoom);
  for (int i = 0; i < 2; ++i) {
    const auto reply = team.ask(map_head(sent, kGzip) + sent);
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 503);
    EXPECT_NE(reply->body.find("the queue of maps is full"), std::string::npos) << reply->body;
  }
  EXPECT_TRUE(team.served.eventually([&] { return team.message_handler.arriving == 0; }));
  const std::string small = gzipped(cloud_body(500'000));
  EXPECT_EQ(team.ask(map_head(small, kGzip) + small)->status, 200) << "the memory is returned";
}

TEST(MapUpload, LeavesNothingStoredIfItFails) {
  Team team;
  const std::string body = cloud_body(200'000);
  RawClient half(team.served.port());
  half.send(map_head(body) + body.substr(0, body.size() / 2));
  EXPECT_TRUE(team.served.eventually([&] { return team.message_handler.stored > 0; }));
  half.reset();
  EXPECT_TRUE(team.served.eventually([&] { return team.message_handler.arriving == 0; }));
  const std::string bad = body.substr(0, body.size() - 1) + "]";
  EXPECT_EQ(team.ask(authorized("POST", "/map/update", kJsonType, bad))->status, 400);
  EXPECT_TRUE(team.served.eventually([&] { return team.message_handler.arriving == 0; }));
  EXPECT_TRUE(team.served.on_loop([&] { return team.message_handler.maps.empty(); }));
}

}  // namespace
}  // namespace adit::intake
