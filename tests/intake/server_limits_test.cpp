#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "intake/raw_client.hpp"
#include "intake/scripted_handler.hpp"
#include "intake/served.hpp"

namespace adit::intake {
namespace {

bool answers(std::uint16_t port, const std::string& source) {
  RawClient client(port, source);
  client.send(request("POST", "/echo", {}, "x"));
  const auto reply = client.reply();
  return reply && reply->status == 200;
}

TEST(ServerLimits, LeaveOthersServedThoughOneAddressOpensThousandsOfConnections) {
  ScriptedHandler handler;
  Served served(handler);
  std::vector<std::unique_ptr<RawClient>> flood;
  constexpr int kFlood = 1500;
  RecordProperty("cases", kFlood);
  for (int i = 0; i < kFlood; ++i) {
    flood.push_back(std::make_unique<RawClient>(served.port(), "127.0.0.2"));
    flood.back()->send("GET /echo HTTP/1.1\r\nX-Slow: ");
    if (i % 250 == 249) {
      EXPECT_TRUE(answers(served.port(), "127.0.0.1")) << i;
      EXPECT_TRUE(served.eventually([&] { return served.server().connections() <= 33; }));
    }
  }
}

TEST(ServerLimits, MakeRoomWhereManyAddressesFillAllConnections) {
  ScriptedHandler handler;
  Served served(handler);
  std::vector<std::unique_ptr<RawClient>> flood;
  for (int i = 0; i < 300; ++i) {
    flood.push_back(std::make_unique<RawClient>(served.port(), "127.0.1." + std::to_string(1 + i % 200)));
    flood.back()->send("GET /echo HTTP/1.1\r\nX-Slow: ");
  }
  EXPECT_TRUE(answers(served.port(), "127.0.0.1"));
  EXPECT_TRUE(served.eventually([&] { return served.server().connections() <= 33; }));
}

TEST(ServerLimits, DoNotEndARequestUnderWayToMakeRoom) {
  ScriptedHandler handler;
  Served served(handler, {.address = "127.0.0.1", .interface = {}, .connections = 4});
  RawClient waiting(served.port());
  waiting.send(request("GET", "/later"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 3; ++i) {
    idle.push_back(std::make_unique<RawClient>(served.port()));
  }
  EXPECT_TRUE(answers(served.port(), "127.0.0.1"));
  EXPECT_TRUE(idle[0]->closes());
  served.on_loop([&] { handler.responders[0]->answer({.body = "1", .headers = {}}); });
  EXPECT_EQ(waiting.reply()->body, "1");
}

TEST(ServerLimits, SurviveGarbage) {
  ScriptedHandler handler;
  Served served(handler);
  const std::string nul("GET /\0 HTTP/1.1\r\n\r\n", 19);
  const std::string requests[] = {
      "\r\n\r\n\r\n",
      "GET\r\n\r\n",
      "GET /echo\r\n\r\n",
      "GET /echo HTTP/0.9\r\n\r\n",
      "GET /echo HTTP/9.9\r\n\r\n",
      "GET  /echo  HTTP/1.1\r\n\r\n",
      nul,
      "GET /echo HTTP/1.1\r\nno colon\r\n\r\n",
      "GET /echo HTTP/1.1\r\n: no name\r\n\r\n",
      "GET /echo HTTP/1.1\r\n folded: x\r\n\r\n",
      "GET /echo HTTP/1.1\nHost: x\n\n",
      "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
      "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03",
      std::string(100000, 'A'),
      "GET /" + std::string(200000, 'a') + " HTTP/1.1\r\n\r\n",
      "GET /echo HTTP/1.1\r\nX: " + std::string(300000, 'a') + "\r\n\r\n",
      request("POST", "/echo", "Transfer-Encoding: chunked\r\n") + "zz\r\n",
      request("POST", "/echo", "Transfer-Encoding: chunked\r\n") + "-5\r\nhello\r\n",
      request("POST", "/echo", "Transfer-Encoding: chunked\r\n") + "ffffffffffffffffff\r\n",
      request("POST", "/echo", "Transfer-Encoding: chunked\r\n") + "5\r\nhelloXX",
  };
  RecordProperty("cases", static_cast<int>(std::size(requests)));  // tests/hostile/run counts them
  for (const std::string& each : requests) {
    RawClient client(served.port());
    client.send(each);
    client.half_close();
    while (const auto reply = client.reply()) {
      EXPECT_TRUE(reply->status == 200 || reply->body.starts_with('"'))
          << each.substr(0, 80) << " -> " << reply->status << " " << reply->body;
    }
    EXPECT_TRUE(answers(served.port(), "127.0.0.1")) << each.substr(0, 80);
  }
  EXPECT_TRUE(served.eventually([&] { return served.server().connections() == 0; }));
  EXPECT_EQ(handler.exchanges, 0);
}

TEST(ServerLimits, SurviveRequestsChangedAtRandom) {
  ScriptedHandler handler;
  Served served(handler);
  std::mt19937_64 random(20210401);
  const auto any = [&](std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(random);
  };
  const std::string originals[] = {
      request("POST", "/echo", "Content-Type: application/json\r\n", "{\"x\": 1}"),
      request("GET", "/echo?q=%20"),
      request("POST", "/echo", "Transfer-Encoding: chunked\r\n") + "5\r\nhello\r\n0\r\n\r\n",
      request("POST", "/refuse", "Expect: 100-continue\r\n", std::string(100, 'x')),
  };
  const auto changed = [&] {
    std::string text = originals[any(std::size(originals))];
    for (std::size_t changes = 1 + any(4); changes > 0 && !text.empty(); --changes) {
      const std::size_t at = any(text.size());
      switch (any(4)) {
        case 0:
          text[at] = static_cast<char>(any(256));
          break;
        case 1:
          text.erase(at, 1 + any(8));
          break;
        case 2:
          text.insert(at, text.substr(any(text.size()), any(20)));
          break;
        default:
          text.resize(at);
      }
    }
    return text;
  };
  constexpr int kRounds = 20, kAtOnce = 15;
  RecordProperty("cases", kRounds * kAtOnce);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::pair<std::string, std::unique_ptr<RawClient>>> crowd;
    for (int i = 0; i < kAtOnce; ++i) {
      crowd.emplace_back(changed(), std::make_unique<RawClient>(served.port()));
      crowd.back().second->send(crowd.back().first);
      crowd.back().second->half_close();
    }
    for (auto& [text, client] : crowd) {
      while (const auto reply = client->reply()) {
        if (reply->status == 100 || reply->status == 200) continue;
        EXPECT_TRUE(nlohmann::json::parse(reply->body, nullptr, false).is_string())
            << text << " -> " << reply->status << " " << reply->body;
      }
    }
  }
  EXPECT_TRUE(answers(served.port(), "127.0.0.1"));
  EXPECT_TRUE(served.eventually([&] { return served.server().connections() == 0; }));
  EXPECT_EQ(handler.exchanges, 0);
}

}  // namespace
}  // namespace adit::intake
