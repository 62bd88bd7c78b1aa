#include "rehearsal/command_post/server.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <array>
#include <cstdio>
#include <exception>

#include "rehearsal/command_post/connection.hpp"

namespace adit::rehearsal {
namespace {

void given_up(const char* why) {
  std::fprintf(stderr, "adit-rehearsal: connection aborted: %s\n", why);
}

}  // namespace

std::expected<std::unique_ptr<Server>, std::string> Server::listen(const Address& address, WireManner manner,
                                                                   Decide decide) {
  auto listener = listening_socket(address);
  if (!listener) return std::unexpected(std::move(listener.error()));
  const auto bound = local_address_of(listener->get());
  if (manner.link) {  // else a whole map waits here, and its sender takes it for sent
    constexpr int most_waiting = 64 << 10;
    ::setsockopt(listener->get(), SOL_SOCKET, SO_RCVBUF, &most_waiting, sizeof most_waiting);
  }
  loop::FileDescriptor stop_event(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!stop_event || !bound) return std::unexpected(address.text() + ": no more file descriptors");
  return std::unique_ptr<Server>(
      new Server(std::move(*listener), std::move(stop_event), *bound, manner, std::move(decide)));
}

Server::Server(loop::FileDescriptor listener, loop::FileDescriptor stop_event, Address address,
               WireManner manner, Decide decide)
    : listener_(std::move(listener)),
      stop_event_(std::move(stop_event)),
      address_(std::move(address)),
      manner_(manner),
      decide_(std::move(decide)),
      acceptor_([this] { accept_all(); }) {}

Server::~Server() {
  stop();
  acceptor_.join();
  std::unique_lock lock(mutex_);
  ended_.wait(lock, [this] { return connections_ == 0; });
}

void Server::stop() {
  // Nobody connects between now and the acceptor's end; those in the queue are reset.
  ::shutdown(listener_.get(), SHUT_RDWR);
  ::eventfd_write(stop_event_.get(), 1);
}

bool Server::drained(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  return ended_.wait_for(lock, patience, [this] { return connections_ == 0; });
}

void Server::accept_all() {
  while (true) {
    std::array<pollfd, 2> waited = {pollfd{stop_event_.get(), POLLIN, 0}, pollfd{listener_.get(), POLLIN, 0}};
    if (poll_again(waited, -1) < 0 || waited[0].revents != 0) return;
    loop::FileDescriptor socket(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (!socket) {
      if ((waited[1].revents & (POLLHUP | POLLERR)) != 0) return;
      continue;
    }
    const int yes = 1;
    ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    {
      const std::lock_guard lock(mutex_);
      if (connections_ == kMostConnections) continue;  // closes it
      ++connections_;
    }
    manner_.serial ? serve(std::move(socket)) : begin(std::move(socket));
  }
}

/// Where there is no thread to be had, the connection is closed, and others are accepted.
void Server::begin(loop::FileDescriptor socket) {
  try {
    std::thread([this, held = std::move(socket)]() mutable { serve(std::move(held)); }).detach();
  } catch (const std::exception& error) {
    given_up(error.what());
    over();
  }
}

void Server::serve(loop::FileDescriptor socket) {
  try {
    Connection connection(std::move(socket), stop_event_.get(), manner_, decide_);
    if (connection.serve() == Connection::End::EndpointDies) stop();
  } catch (const std::exception& error) {  // memory that has run out
    given_up(error.what());
  }
  over();
}

/// The last touch of this object by a connection: whoever waits for it may end it once the lock is free.
void Server::over() {
  const std::lock_guard lock(mutex_);
  --connections_;
  ended_.notify_all();
}

}  // namespace adit::rehearsal
