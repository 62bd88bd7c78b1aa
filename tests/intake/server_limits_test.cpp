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

TEST(ServerLimits, KeepOtherAddressesServedInAFloodOfConnections) {
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
      "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03",  // TLS
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
