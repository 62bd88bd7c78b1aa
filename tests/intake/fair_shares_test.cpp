// A client that sends all it can leaves memory and turns for other addresses.
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
  /// Sends all but the last byte of `body` on a new connection of the greedy address.
  void send_one_more(std::string_view path, const std::string& body) {
    const std::string length = "Content-Length: " + std::to_string(body.size()) + "\r\n";
    greedy.push_back(std::make_unique<RawClient>(team.served.port(), kGreedy));
    greedy.back()->send(request("POST", path, std::string(kJsonType) + length) +
                        body.substr(0, body.size() - 1));
  }
  /// The first rejection of further connections of the greedy address. Earlier rejections return memory, so
  /// some connections may find room first.
  std::optional<Reply> next_refused(std::string_view path, const std::string& body) {
    using namespace std::chrono_literals;
    for (int i = 0; i < 20; ++i) {
      send_one_more(path, body);
      if (auto reply = greedy.back()->reply(i < 19 ? 100ms : 10s)) return reply;
    }
    return std::nullopt;
  }
  /// Another address has room for `body` although the greedy one has used its share. Returns the greedy one's
  /// rejection.
  Reply expect_room(std::string_view path, const std::string& body) {
    for (int i = 0; i < 20; ++i) send_one_more(path, body);
    EXPECT_TRUE(team.served.eventually([&] { return !team.message_handler.refusals.empty(); }));
    RawClient other(team.served.port(), kOther);
    other.send(request("POST", path, kJsonType, body));
    const auto reply = other.reply();
    EXPECT_TRUE(reply && reply->status == 200);
    return next_refused(path, body).value_or(Reply());
  }

  Team team{options()};
  std::vector<std::unique_ptr<RawClient>> greedy;
};

TEST_F(FairShares, AcceptMapsOfAnotherAddress) {
  EXPECT_EQ(expect_room("/map/update", grid_body(300, 300)).status, 429);
}

TEST_F(FairShares, AcceptStatesOfAnotherAddress) {
  const Reply refused = expect_room("/state/update", std::string(kStateBody).insert(1, 100'000, ' '));
  EXPECT_EQ(refused.status, 503);
  EXPECT_EQ(refused.header("retry-after"), "1");
  EXPECT_TRUE(is_json_string(refused.body)) << refused.body;
}

TEST(FairTurns, AlternateBetweenAddresses) {
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
    ASSERT_EQ(team.message_handler.senders.size(), 4u);
    EXPECT_LT(std::ranges::find(team.message_handler.senders, kOther, &Sender::address) -
                  team.message_handler.senders.begin(),
              3);
  });
}

}  // namespace
}  // namespace adit::intake
