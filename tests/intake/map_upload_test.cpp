#include <gtest/gtest.h>

#include "codec/deflated.hpp"
#include "intake/team.hpp"
#include "intake/uploads.hpp"

namespace adit::intake {
namespace {

using codec::test::gzipped;
using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(MapUpload, ReachesTheDeskDecoded) {
  Team team;
  const auto reply = team.ask(authorized("POST", "/map/update", kJsonType, grid_body(640, 480)));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 200) << reply->body;
  EXPECT_EQ(reply->body, "null");
  team.served.on_loop([&] {
    ASSERT_EQ(team.message_handler.maps.size(), 1u);
    const icd::MapUpdate& map = team.message_handler.maps[0];
    ASSERT_TRUE(map.is_grid());
    EXPECT_EQ(std::get<icd::OccupancyGrid>(map.msg).width, 640u);
    EXPECT_EQ(map.data.raw_size, 640u * 480u);
    EXPECT_EQ(map.name->text(), "r1");
    EXPECT_EQ(team.message_handler.senders.at(0).bytes, grid_body(640, 480).size());
  });
}

TEST(MapUpload, DelaysTheClientWhileTheWorkerIsBusy) {
  Team team;
  Team::Busy busy(team);
  const std::string body = grid_body(4000, 4000);
  RawClient client(team.served.port());
  client.send(map_head(body));
  const std::size_t sent = client.send_until_stalled(body, milliseconds(500));
  EXPECT_LT(sent, body.size()) << "the server must not buffer the body";
  EXPECT_EQ(team.ask(authorized("POST", "/state/update", kJsonType, kStateBody))->status, 200)
      << "the loop must not wait for the worker";
  busy.end();
  client.send(std::string_view(body).substr(sent));
  const auto reply = client.reply(seconds(30));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 200) << reply->body;
}

TEST(MapUpload, IsDroppedIfItsClientDisconnects) {
  Team team;
  const std::string body = grid_body(300, 300);
  {
    Team::Busy busy(team);
    RawClient whole(team.served.port());
    whole.send(map_head(body) + body);
    RawClient half(team.served.port());
    half.send(map_head(body) + body.substr(0, body.size() / 2));
    ASSERT_TRUE(team.served.eventually([&] { return team.served.server().connections() == 2; }));
    team.served.turn_often();
    whole.reset();
    half.reset();
    EXPECT_TRUE(team.served.eventually([&] { return team.served.server().connections() == 0; }));
  }
  EXPECT_EQ(team.ask(authorized("POST", "/map/update", kJsonType, body))->status, 200);
  team.served.on_loop([&] {
    EXPECT_EQ(team.message_handler.maps.size(), 1u);
    EXPECT_TRUE(team.message_handler.refusals.empty());
  });
}

TEST(MapUpload, IsAnsweredOnceTheDeskHasStoredIt) {
  Team team;
  team.served.on_loop([&] { team.message_handler.stores_at_once = false; });
  const std::string body = grid_body(300, 300);
  RawClient client(team.served.port());
  client.send(map_head(body) + body);
  ASSERT_TRUE(team.served.eventually([&] { return team.message_handler.storing.size() == 1; }));
  EXPECT_FALSE(client.reply(milliseconds(200)));
  team.served.on_loop([&] { team.message_handler.storing.front()(); });
  EXPECT_EQ(client.reply()->status, 200);
}

/// The message handler owns the map then and must answer.
TEST(MapUpload, IsRejectedIfTheDeskFails) {
  Team team;
  const std::string sent = authorized("POST", "/map/update", kJsonType, grid_body(300, 300));
  team.served.on_loop([&] { team.message_handler.fails = true; });
  const auto reply = team.ask(sent);
  ASSERT_TRUE(reply) << "no answer";
  EXPECT_EQ(reply->status, 503);
  EXPECT_TRUE(team.served.eventually([&] { return team.message_handler.arriving == 0; }))
      << "its file is released";
  team.served.on_loop([&] { team.message_handler.fails = false; });
  EXPECT_EQ(team.ask(sent)->status, 200);
  EXPECT_EQ(team.served.on_loop([&] { return team.message_handler.maps.size(); }), 1u);
}

TEST(MapUpload, IsStoredIfItsClientDisconnectsMeanwhile) {
  Team team;
  team.served.on_loop([&] { team.message_handler.stores_at_once = false; });
  const std::string body = grid_body(300, 300);
  {
    RawClient client(team.served.port());
    client.send(map_head(body) + body);
    ASSERT_TRUE(team.served.eventually([&] { return team.message_handler.storing.size() == 1; }));
    client.reset();
    ASSERT_TRUE(team.served.eventually([&] { return team.served.server().connections() == 0; }));
  }
  team.served.on_loop([&] {
    team.message_handler.storing.front()();
    EXPECT_EQ(team.message_handler.maps.size(), 1u);
    EXPECT_TRUE(team.message_handler.refusals.empty());
    EXPECT_EQ(team.message_handler.arriving, 0);
  });
}

TEST(MapUpload, IsRejectedDuringAStopUnlessTheDeskHasIt) {
  Team team;
  team.served.on_loop([&] { team.message_handler.stores_at_once = false; });
  const std::string body = grid_body(300, 300);
  RawClient kept(team.served.port()), half(team.served.port()), state(team.served.port());
  kept.send(map_head(body) + body);
  ASSERT_TRUE(team.served.eventually([&] { return team.message_handler.storing.size() == 1; }));
  half.send(map_head(body) + body.substr(0, body.size() / 2));
  state.send(
      authorized("POST", "/state/update",
                 std::string(kJsonType) + "Content-Length: " + std::to_string(kStateBody.size()) + "\r\n") +
      std::string(kStateBody.substr(0, 10)));
  team.served.turn_often();
  team.served.on_loop([&] { team.front.routes->stop(); });
  const auto told = half.reply();
  ASSERT_TRUE(told);
  EXPECT_EQ(told->status, 503);
  EXPECT_TRUE(is_json_string(told->body)) << told->body;
  state.send(kStateBody.substr(10));
  EXPECT_EQ(state.reply()->status, 503);
  EXPECT_EQ(team.ask(authorized("POST", "/map/update", kJsonType, body))->status, 503);
  EXPECT_EQ(team.ask(authorized("POST", "/markers/update", kJsonType, kMarkersBody))->status, 503);
  team.served.on_loop([&] { team.message_handler.storing.front()(); });
  EXPECT_EQ(kept.reply()->status, 200);
  team.served.on_loop([&] {
    EXPECT_EQ(team.message_handler.maps.size(), 1u);
    EXPECT_TRUE(team.message_handler.states.empty() && team.message_handler.markers.empty());
  });
}

TEST(MapUpload, IsRejectedIfTheBudgetIsUsedUp) {
  IcdOptions options = Team::with_tokens();
  options.upload_bytes = 200'000;
  Team team(options);
  const std::string body = grid_body(300, 300);
  {
    Team::Busy busy(team);
    RawClient first(team.served.port());
    first.send(map_head(body) + body);
    team.served.turn_often();
    const auto reply = team.ask(map_head(body) + body);
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 429);
    EXPECT_TRUE(is_json_string(reply->body));
    busy.end();
    EXPECT_EQ(first.reply()->status, 200);
  }
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(team.ask(map_head(body) + body)->status, 200) << "the budget is not returned";
}

TEST(MapUpload, ReturnsItsBudgetIfItFails) {
  IcdOptions options = Team::with_tokens();
  options.upload_bytes = 200'000;
  Team team(options);
  const std::string body = grid_body(300, 300);
  for (int i = 0; i < 10; ++i) {
    // The worker may still hold a part of the lost upload.
    bool given_back = false;
    for (int tries = 0; tries < 100 && !given_back; ++tries) {
      given_back = team.ask(map_head(body) + "{]" + body.substr(2))->status == 400;
    }
    EXPECT_TRUE(given_back);
    RawClient lost(team.served.port());
    lost.send(map_head(body) + body.substr(0, 100'000));
    lost.reset();
    ASSERT_TRUE(team.served.eventually([&] { return team.served.server().connections() == 0; }));
  }
  int status = 0;
  for (int tries = 0; tries < 100 && status != 200; ++tries) {
    status = team.ask(map_head(body) + body)->status;
  }
  EXPECT_EQ(status, 200);
}

TEST(MapUpload, CountsItsInflatedSizeInTheBudget) {
  IcdOptions options = Team::with_tokens();
  options.upload_bytes = 1'500'000;
  Team team(options);
  const auto status_of = [&team](const std::string& body) {
    const std::string sent = gzipped(body);
    EXPECT_LT(sent.size(), 50'000u);
    return team.ask(map_head(sent, kGzip) + sent)->status;
  };
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(status_of(grid_with_late_type(1000, 1000)), 200);
    EXPECT_EQ(status_of(grid_with_late_type(2000, 1000)), 429);
    EXPECT_EQ(status_of(grid_body(2000, 1000)), 200) << "compressed as it arrives";
  }
  const std::string body = grid_body(1100, 1100);
  EXPECT_EQ(team.ask(map_head(body) + body)->status, 429) << "the body is too large";
}

TEST(MapUpload, IsRejectedIfItInflatesTooFar) {
  IcdOptions options = Team::with_tokens();
  options.rules.map_bytes = 100'000;
  Team team(options);
  const std::string bomb = gzipped(grid_body(2000, 2000));
  const auto reply = team.ask(map_head(bomb, kGzip) + bomb);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 413) << reply->body;
  const std::string large = grid_body(400, 400);
  const auto other = team.ask(map_head(large) + large);
  ASSERT_TRUE(other);
  EXPECT_EQ(other->status, 413) << other->body;
  EXPECT_TRUE(team.served.on_loop([&] { return team.message_handler.maps.empty(); }));
}

TEST(MapUpload, EndsWithTheServerInEveryPhase) {
  Team team;
  const std::string body = grid_body(3000, 3000);
  Team::Busy busy(team);
  std::vector<std::unique_ptr<RawClient>> clients;
  for (const std::size_t size : {std::size_t{0}, std::size_t{10}, std::size_t{500'000}, body.size() / 2}) {
    clients.push_back(std::make_unique<RawClient>(team.served.port()));
    clients.back()->send(map_head(body));
    clients.back()->send_until_stalled(std::string_view(body).substr(0, size), milliseconds(50));
  }
  team.served.on_loop([&] { team.served.destroy_server(); });
  for (auto& client : clients) EXPECT_TRUE(client->closes());
  busy.end();
  std::this_thread::sleep_for(milliseconds(50));
  team.served.on_loop([&] { EXPECT_TRUE(team.message_handler.maps.empty()); });
}

TEST(MapUpload, EndsWithABusyWorker) {
  Team team;
  const std::string body = grid_body(3000, 3000);
  RawClient client(team.served.port());
  client.send(map_head(body));
  // Without its last byte, the map cannot be accepted yet.
  client.send_until_stalled(std::string_view(body).substr(0, body.size() - 1), milliseconds(20));
  team.served.on_loop([&] {
    team.front.workers = nullptr;  // waits for the busy one
    team.served.destroy_server();
    EXPECT_TRUE(team.message_handler.maps.empty());
  });
}

}  // namespace
}  // namespace adit::intake
