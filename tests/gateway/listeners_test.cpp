#include "gateway/listeners.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <string>

#include "intake/not_found.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/turn_until.hpp"

namespace adit::gateway {
namespace {

using namespace std::chrono_literals;

/// A client that stays connected.
class Client {
 public:
  explicit Client(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(port);
    ::inet_pton(AF_INET, "127.0.0.1", &at.sin_addr);
    connected_ = ::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0;
  }
  bool connected() const { return connected_; }
  void ask() { send("GET / HTTP/1.1\r\nHost: x\r\n\r\n"); }
  void send(std::string_view bytes) {
    EXPECT_EQ(::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  /// The received bytes; "": the connection has ended.
  std::optional<std::string> heard() {
    char bytes[4096];
    const ssize_t got = ::recv(socket_.get(), bytes, sizeof bytes, MSG_DONTWAIT);
    if (got < 0) return std::nullopt;
    return std::string(bytes, static_cast<std::size_t>(got));
  }

 private:
  loop::FileDescriptor socket_;
  bool connected_ = false;
};

class ListenersTest : public testing::Test {
 protected:
  ListenersTest() {
    team_.listen = {{"127.0.0.1", free_port()}};
    listeners_.set_drain_time(1h);
  }
  /// The port of a socket that was closed again.
  static std::uint16_t free_port() {
    const auto socket = intake::open_listen_socket({.address = "127.0.0.1", .interface = ""});
    return intake::bound_at(socket->get())->port;
  }
  std::uint16_t port() const { return team_.listen.front().port; }
  bool serve() {
    const bool served = listeners_.serve(team_).has_value();
    if (served) sockets_.settle();
    return served;
  }
  std::string answer_to(Client& client) {
    client.ask();
    std::optional<std::string> heard;
    EXPECT_TRUE(loop::turn_until(loop_, [&] {
      if (!heard) heard = client.heard();
      return heard.has_value();
    }));
    return heard.value_or("").substr(0, 12);
  }
  bool connections_come_to(std::size_t count) {
    return loop::turn_until(loop_, [&] {
      listeners_.tick();
      return listeners_.connections() == count;
    });
  }

  const std::string kAnswered = "HTTP/1.1 404";
  loop::Loop loop_;
  ListenSockets sockets_;
  intake::NotFound handler_;
  settings::Team team_;
  intake::TokenGuesses guesses_;
  Listeners listeners_{loop_, sockets_, handler_, guesses_, nullptr};
};

TEST_F(ListenersTest, ConnectionsOfAKeptSocketContinue) {
  ASSERT_TRUE(serve());
  Client client(port());
  EXPECT_EQ(answer_to(client), kAnswered);
  team_.listen.push_back({"127.0.0.1", free_port()});
  ASSERT_TRUE(serve());
  EXPECT_EQ(answer_to(client), kAnswered);
  Client other(team_.listen.back().port);
  EXPECT_EQ(answer_to(other), kAnswered);
}

TEST_F(ListenersTest, ClosedSocketServesItsConnectionsForAWhile) {
  ASSERT_TRUE(serve());
  Client client(port());
  EXPECT_EQ(answer_to(client), kAnswered);
  listeners_.set_drain_time(100ms);
  const std::uint16_t before = port();
  team_.listen = {{"127.0.0.1", free_port()}};
  ASSERT_TRUE(serve());
  EXPECT_EQ(answer_to(client), kAnswered);
  EXPECT_FALSE(Client(before).connected());
  EXPECT_TRUE(connections_come_to(0));
  EXPECT_EQ(client.heard(), "");
}

TEST_F(ListenersTest, PortsAreOpenUntilTheirLastClientIsServed) {
  ASSERT_TRUE(serve());
  EXPECT_EQ(listeners_.ports(), network::TeamPorts{}) << "other machines cannot reach loopback";
  team_.listen = {{"0.0.0.0", free_port()}};
  const std::uint16_t before = port();
  ASSERT_TRUE(serve());
  EXPECT_EQ(listeners_.ports(), network::TeamPorts{{before}});
  Client client(before);
  EXPECT_EQ(answer_to(client), kAnswered);
  listeners_.set_drain_time(100ms);
  team_.listen = {{"0.0.0.0", free_port()}};
  ASSERT_TRUE(serve());
  EXPECT_EQ(listeners_.ports(), network::TeamPorts({{std::min(before, port()), std::max(before, port())}}));
  EXPECT_TRUE(connections_come_to(0));
  EXPECT_EQ(listeners_.ports(), network::TeamPorts{{port()}});
}

TEST_F(ListenersTest, SocketForStunnelIsNoAddressOfTheSettings) {
  std::vector<host::InheritedDescriptor> given;
  given.push_back({"tls", std::move(*intake::open_listen_socket({.address = "127.0.0.1", .interface = ""}))});
  const std::uint16_t tls = intake::port_of(given[0].descriptor.get());
  sockets_ = *ListenSockets::take_over(std::move(given));
  EXPECT_FALSE(listeners_.serves_tls());
  ASSERT_TRUE(serve());
  EXPECT_TRUE(listeners_.serves_tls());
  EXPECT_EQ(listeners_.ports(), network::TeamPorts{{network::kTlsPort}})
      << "the firewall opens stunnel's port";
  Client client(tls);
  client.send("PROXY TCP4 10.0.0.5 10.0.0.1 49152 443\r\n");
  EXPECT_EQ(answer_to(client), kAnswered);
  team_.listen = {{"127.0.0.1", tls}};
  EXPECT_FALSE(serve());
}

TEST_F(ListenersTest, NewLimitsApplyToNewConnections) {
  ASSERT_TRUE(serve());
  Client client(port());
  EXPECT_EQ(answer_to(client), kAnswered);
  listeners_.set_drain_time(0ms);
  team_.connections_per_address = 1;
  ASSERT_TRUE(serve());
  listeners_.tick();
  EXPECT_EQ(answer_to(client), kAnswered) << "the socket must still be served";
  Client other(port());
  EXPECT_EQ(answer_to(other), kAnswered);
  EXPECT_EQ(listeners_.connections(), 2u);
}

TEST_F(ListenersTest, UnusableAddressKeepsTheOtherSockets) {
  ASSERT_TRUE(serve());
  Client client(port());
  EXPECT_EQ(answer_to(client), kAnswered);
  const settings::Team before = team_;
  team_.listen = {{"192.0.2.1", port()}};  // no machine has this address
  EXPECT_FALSE(serve());
  team_ = before;
  ASSERT_TRUE(serve());
  EXPECT_EQ(answer_to(client), kAnswered);
  Client other(port());
  EXPECT_EQ(answer_to(other), kAnswered);
}

}  // namespace
}  // namespace adit::gateway
