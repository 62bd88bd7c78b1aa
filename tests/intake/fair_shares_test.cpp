// Memory and turns are shared by addresses, by real sockets: one that sends as much as it can, with or
// without a token, leaves room for others.
#include <gtest/gtest.h>

#include "intake/team.hpp"

namespace adit::intake {
namespace {

const std::string kGreedy = "127.0.0.2", kOther = "127.0.0.3";

class FairShares : public testing::Test {
 protected:
  static IcdOptions options() {
    IcdOptions options;
    options.asks_token = false;
    options.upload_bytes = options.small_bytes = 1'000'000;
    return options;
  }
  /// Connections of the greedy address, each of which has sent all but the end of `body`.
  void send_greedily(std::string_view path, const std::string& body) {
    for (int i = 0; i < 20; ++i) send_one_more(path, body);
  }
  void send_one_more(std::string_view path, const std::string& body) {
    const std::string length = "Content-Length: " + std::to_string(body.size()) + "\r\n";
    greedy.push_back(std::make_unique<RawClient>(team.served.port(), kGreedy));
    greedy.back()->send(request("POST", path, std::string(kJsonType) + length) +
                        body.substr(0, body.size() - 1));
  }
  /// Of one more and one more of the greedy, the first that is answered though it is not whole. What was
  /// refused before has given its memory back, so some may find room first.
  std::optional<Reply> next_refused(std::string_view path, const std::string& body) {
    using namespace std::chrono_literals;
    for (int i = 0; i < 20; ++i) {
      send_one_more(path, body);
      if (auto reply = greedy.back()->reply(i < 19 ? 100ms : 10s)) return reply;
    }
    return std::nullopt;
  }
  std::optional<Reply> ask_from(const std::string& address, std::string_view path, const std::string& body) {
    RawClient client(team.served.port(), address);
    client.send(request("POST", path, kJsonType, body));
    return client.reply();
  }
  /// Those of the greedy that were refused, once one was.
  std::size_t refusals() {
    EXPECT_TRUE(team.served.eventually([&] { return !team.desk.refusals.empty(); }));
    return team.served.on_loop([&] { return team.desk.refusals.size(); });
  }

  Team team{options()};
  std::vector<std::unique_ptr<RawClient>> greedy;
};

TEST_F(FairShares, OfMapsAreLeftForAnotherAddress) {
  const std::string body = grid_body(300, 300);
  send_greedily("/map/update", body);
  EXPECT_GE(refusals(), 1u);
  const auto reply = ask_from(kOther, "/map/update", body);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 200) << reply->body;
  const auto refused = next_refused("/map/update", body);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 429);
}

TEST_F(FairShares, OfStatesAreLeftForAnotherAddress) {
  const std::string body = std::string(kStateBody).insert(1, 100'000, ' ');
  send_greedily("/state/update", body);
  EXPECT_GE(refusals(), 1u);
  const auto reply = ask_from(kOther, "/state/update", body);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 200) << reply->body;
  const auto refused = next_refused("/state/update", body);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 503);
  EXPECT_EQ(refused->header("retry-after"), "1");
  EXPECT_TRUE(is_json_string(refused->body)) << refused->body;
}

TEST(FairTurns, OfLargeMarkersAreOfOneAddressAfterTheOther) {
  Team team;
  const std::string large =
      R"({"markers":[{"action":3,"text":")" + std::string(std::size_t{11} << 17, 'x') + R"("}]})";
  Team::Busy busy(team);
  std::vector<std::unique_ptr<RawClient>> clients;
  const auto send_from = [&](const std::string& address) {
    clients.push_back(std::make_unique<RawClient>(team.served.port(), address));
    clients.back()->send(authorized("POST", "/markers/update", kJsonType, large));
    for (int i = 0; i < 3; ++i) team.served.turn_often();
  };
  for (int i = 0; i < 3; ++i) send_from(kGreedy);
  send_from(kOther);
  busy.end();
  for (const auto& client : clients) EXPECT_EQ(client->reply()->status, 200);
  team.served.on_loop([&] {
    ASSERT_EQ(team.desk.senders.size(), 4u);
    EXPECT_LT(std::ranges::find(team.desk.senders, kOther, &Sender::address) - team.desk.senders.begin(), 3);
  });
}

}  // namespace
}  // namespace adit::intake
