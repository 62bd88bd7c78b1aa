#include "uplink/socket.hpp"

#include <gmock/gmock.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "peer.hpp"

namespace adit::uplink {
namespace {

template <class T>
T option(const loop::FileDescriptor& fd, int level, int name) {
  T value{};
  socklen_t size = sizeof value;
  EXPECT_EQ(::getsockopt(fd.get(), level, name, &value, &size), 0);
  return value;
}

loop::FileDescriptor socket_of(const Endpoint& endpoint) {
  auto fd = begin_connect(endpoint);
  EXPECT_TRUE(fd) << fd.error().why;
  return fd ? std::move(*fd) : loop::FileDescriptor();
}

TEST(Socket, SendsAtOnceAndNoticesADeadPeer) {
  const ListeningPeer peer([](Wire& wire) { wire.wait_for_close(); });
  const auto fd = socket_of(peer.endpoint());
  EXPECT_EQ(option<int>(fd, IPPROTO_TCP, TCP_NODELAY), 1);
  EXPECT_EQ(option<int>(fd, SOL_SOCKET, SO_KEEPALIVE), 1);
  EXPECT_EQ(option<int>(fd, IPPROTO_TCP, TCP_KEEPIDLE), 5);
  give_up_after(fd.get(), std::chrono::milliseconds(1234));
  EXPECT_EQ(option<int>(fd, IPPROTO_TCP, TCP_USER_TIMEOUT), 1234);
}

TEST(Socket, IsPacedByTheKernelWhereAPaceIsAskedFor) {
  const ListeningPeer peer([](Wire& wire) { wire.wait_for_close(); });
  Endpoint endpoint = peer.endpoint();
  EXPECT_EQ(option<std::uint64_t>(socket_of(endpoint), SOL_SOCKET, SO_MAX_PACING_RATE), ~std::uint64_t{0});
  for (const std::uint64_t pace :
       {std::uint64_t{12'500}, std::uint64_t{5'000'000'000}}) {  // past 32 bits, too
    endpoint.bytes_per_second = pace;
    EXPECT_EQ(option<std::uint64_t>(socket_of(endpoint), SOL_SOCKET, SO_MAX_PACING_RATE), pace);
  }
}

TEST(Socket, HoldsLittleThatIsNotOnItsWay) {
  const ListeningPeer peer([](Wire& wire) { wire.wait_for_close(); });
  Endpoint endpoint = peer.endpoint();
  EXPECT_EQ(option<int>(socket_of(endpoint), IPPROTO_TCP, TCP_NOTSENT_LOWAT), 64 * 1024);
  endpoint.bytes_per_second = 11'000'000;
  EXPECT_EQ(option<int>(socket_of(endpoint), IPPROTO_TCP, TCP_NOTSENT_LOWAT), 256 * 1024);
  endpoint.bytes_per_second = 100'000;
  EXPECT_EQ(option<int>(socket_of(endpoint), IPPROTO_TCP, TCP_NOTSENT_LOWAT), 25'000);
}

TEST(Socket, NamesItsPeerAsHttpDoes) {
  const auto authority = [](const char* address, std::uint16_t port) {
    Endpoint endpoint;
    endpoint.address = address;
    endpoint.port = port;
    return authority_of(endpoint);
  };
  EXPECT_EQ(authority("10.100.1.200", 8000), "10.100.1.200:8000");
  EXPECT_EQ(authority("fd00::1", 80), "[fd00::1]:80");
  EXPECT_EQ(authority("fe80::1%darpa0", 80), "[fe80::1]:80");
}

}  // namespace
}  // namespace adit::uplink
