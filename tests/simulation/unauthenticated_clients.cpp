#include "simulation/unauthenticated_clients.hpp"

#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string_view>
#include <utility>

#include "simulation/manners.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

/// Addresses of no client of the team. A client there would lose connections to the share of
/// unauthenticated ones.
constexpr int kFirst = 120, kAddresses = 4, kMost = 80;
constexpr std::string_view kBegun =
    "POST /adit/login HTTP/1.1\r\nHost: 10.0.0.1\r\nContent-Type: application/json\r\nContent-Length: "
    "4000\r\n\r\n{";

}  // namespace

UnauthenticatedClients::UnauthenticatedClients(World& world, double until)
    : world_(world), random_(world.random("strangers")), until_(until) {
  if (world_.omits("strangers")) return;
  const double begin = random_.uniform(0, until_);
  for (std::uint64_t i = 8 + random_.uniform_index(kMost - 8); i > 0; --i) {
    sockets_.push_back(
        std::make_unique<Socket>(Socket{.address = address(kFirst + static_cast<int>(i % kAddresses))}));
    world_.after(seconds(begin + random_.uniform(0, 1)),
                 [this, one = sockets_.back().get()] { connect(*one); });
  }
}

UnauthenticatedClients::~UnauthenticatedClients() {
  for (const auto& socket : sockets_) close(*socket);
}

void UnauthenticatedClients::connect(Socket& socket) {
  if (world_.time() > until_) return;
  socket.fd = world_.door().connect(socket.address);
  socket.watch = world_.descriptors().add(socket.fd, EPOLLIN | EPOLLRDHUP,
                                          [this, one = &socket](std::uint32_t) { read(*one); });
  ::send(socket.fd, kBegun.data(), kBegun.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  send_a_byte(socket);
}

void UnauthenticatedClients::close(Socket& socket) {
  if (socket.fd < 0) return;
  world_.descriptors().remove(socket.watch);
  world_.door().closed(socket.fd);
  ::close(std::exchange(socket.fd, -1));
}

void UnauthenticatedClients::send_a_byte(Socket& socket) {
  world_.after(seconds(random_.uniform(1, 10)), [this, one = &socket, fd = socket.fd] {
    if (fd < 0 || one->fd != fd) return;
    if (world_.time() > until_) return close(*one);
    ::send(fd, " ", 1, MSG_NOSIGNAL | MSG_DONTWAIT);
    send_a_byte(*one);
  });
}

void UnauthenticatedClients::read(Socket& socket) {
  std::array<char, 4096> bytes{};
  const ssize_t got = ::recv(socket.fd, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (got > 0 || (got < 0 && errno == EAGAIN)) return;
  close(socket);
  world_.after(seconds(random_.uniform(0.1, 2)), [this, one = &socket] { connect(*one); });
}

}  // namespace adit::simulation
