#include "intake/listen_socket.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

namespace adit::intake {
namespace {

using testing::HasSubstr;

Listen at(std::string address, std::uint16_t port, std::string interface = "") {
  return {.address = std::move(address), .port = port, .interface = std::move(interface)};
}

TEST(ListenSocket, HasItsAddress) {
  const auto opened = open_listen_socket(at("127.0.0.1", 0, "lo"));
  ASSERT_TRUE(opened) << opened.error();
  const auto bound = bound_at(opened->get());
  ASSERT_TRUE(bound) << bound.error();
  EXPECT_EQ(bound->address, "127.0.0.1");
  EXPECT_NE(bound->port, 0);
  EXPECT_EQ(bound->interface, "lo");
  const auto everywhere = open_listen_socket(at("::", 0));
  ASSERT_TRUE(everywhere) << everywhere.error();
  EXPECT_EQ(bound_at(everywhere->get())->address, "::");
  EXPECT_FALSE(bound_at(everywhere->get())->only_v6);
}

TEST(ListenSocket, MayBeOpenedBeforeItsAddressExists) {
  for (const char* address : {"192.0.2.1", "2001:db8::1"}) {
    Listen listen = at(address, 0);
    EXPECT_THAT(open_listen_socket(listen).error(), HasSubstr("Cannot assign requested address"));
    listen.free_bind = true;
    const auto opened = open_listen_socket(listen);
    ASSERT_TRUE(opened) << opened.error();
    EXPECT_EQ(bound_at(opened->get())->address, address);
  }
}

TEST(ListenSocket, IsNoOtherDescriptor) {
  const loop::FileDescriptor idle(socket(AF_INET, SOCK_STREAM, 0)), datagrams(socket(AF_INET, SOCK_DGRAM, 0)),
      local(socket(AF_UNIX, SOCK_STREAM, 0)), file(open("/dev/null", O_RDONLY));
  EXPECT_THAT(bound_at(idle.get()).error(), HasSubstr("a socket that does not listen"));
  EXPECT_THAT(bound_at(datagrams.get()).error(), HasSubstr("not a stream"));
  EXPECT_THAT(bound_at(local.get()).error(), HasSubstr("another family"));
  EXPECT_THAT(bound_at(file.get()).error(), HasSubstr("no socket"));
  EXPECT_THAT(bound_at(-1).error(), HasSubstr("no socket"));
}

TEST(ListenSocket, DoesNotBlockIfItIsAdopted) {
  const loop::FileDescriptor theirs(socket(AF_INET, SOCK_STREAM, 0));
  ASSERT_EQ(listen(theirs.get(), 1), 0);
  ASSERT_TRUE(adopt_listen_socket(theirs.get(), {}));
  EXPECT_NE(fcntl(theirs.get(), F_GETFL) & O_NONBLOCK, 0);
  int keepalive = 0;
  socklen_t size = sizeof keepalive;
  getsockopt(theirs.get(), SOL_SOCKET, SO_KEEPALIVE, &keepalive, &size);
  EXPECT_EQ(keepalive, 1);
  EXPECT_FALSE(adopt_listen_socket(-1, {}));
}

TEST(ListenSocket, CoversItsAddresses) {
  struct Case {
    ListenAddress bound;
    Listen wanted;
    bool covers;
  };
  const Case cases[] = {
      {{"10.0.0.1", 80, "team0"}, at("10.0.0.1", 80, "team0"), true},
      {{"10.0.0.1", 80, "team0"}, at("10.0.0.1", 8000, "team0"), false},
      {{"10.0.0.1", 80, "team0"}, at("10.0.0.2", 80, "team0"), false},
      {{"10.0.0.1", 80, "team0"}, at("10.0.0.1", 80, "team1"), false},
      {{"10.0.0.1", 80, "team0"}, at("10.0.0.1", 80), true},
      {{"10.0.0.1", 80}, at("10.0.0.1", 80, "team0"), false},
      {{"0.0.0.0", 80, "team0"}, at("10.0.0.1", 80, "team0"), true},
      {{"0.0.0.0", 80, "team0"}, at("0.0.0.0", 80, "team0"), true},
      {{"0.0.0.0", 80, "team0"}, at("fd00::1", 80, "team0"), false},
      {{"0.0.0.0", 80, "team0"}, at("::", 80, "team0"), false},
      {{"::", 80, "team0"}, at("10.0.0.1", 80, "team0"), true},
      {{"::", 80, "team0"}, at("fd00::1", 80, "team0"), true},
      {{"::", 80, "team0", true}, at("fd00::1", 80, "team0"), true},
      {{"::", 80, "team0", true}, at("0.0.0.0", 80, "team0"), false},
      {{"fd00::1", 80, "team0"}, at("fd00:0::0:1", 80, "team0"), true},
      {{"10.0.0.1", 80, "team0"}, at("0.0.0.0", 80, "team0"), false},
      {{"10.0.0.1", 80, "team0"}, at("10.0.0.1", 0, "team0"), false},
  };
  for (const auto& [bound, wanted, covers] : cases) {
    EXPECT_EQ(intake::covers(bound, wanted), covers)
        << bound.address << ' ' << bound.port << ' ' << bound.interface << " and " << wanted.address << ' '
        << wanted.port << ' ' << wanted.interface;
  }
}

}  // namespace
}  // namespace adit::intake
