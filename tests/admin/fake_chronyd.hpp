#pragma once

#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/socket.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "clock/chrony.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"

namespace adit::admin {

/// Answers with the values that a test sets.
class FakeChronyd {
 public:
  explicit FakeChronyd(loop::Loop& loop) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (bind(fd_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return;
    asked_ = loop.watch(fd_.get(), EPOLLIN, [this](std::uint32_t) { answer(); });
  }

  std::uint16_t port() const {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    getsockname(fd_.get(), reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.sin_port);
  }

  clock::Tracking told;
  int answers = 0;

 private:
  using Bytes = clock::TrackingRequest;

  static void put(Bytes& bytes, std::size_t at, std::uint64_t number, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
      bytes[at + i] = static_cast<std::uint8_t>(number >> (8 * (size - 1 - i)));
  }
  static std::uint32_t real(double number) {
    int exponent = 0;
    const double fraction = std::frexp(number, &exponent);
    const auto coefficient = static_cast<std::int32_t>(std::lround(fraction * (1 << 24)));
    return static_cast<std::uint32_t>(exponent + 1) << 25 |
           (static_cast<std::uint32_t>(coefficient) & ((1U << 25) - 1));
  }

  void answer() {
    Bytes asked{};
    sockaddr_in from{};
    socklen_t size = sizeof from;
    if (recvfrom(fd_.get(), asked.data(), asked.size(), 0, reinterpret_cast<sockaddr*>(&from), &size) < 12)
      return;
    Bytes reply{6, 2, 0, 0, 0, 33, 0, 5};
    for (std::size_t i = 0; i < 4; ++i) reply[16 + i] = asked[8 + i];
    put(reply, 32, told.server, 4);
    put(reply, 48, 1, 2);
    put(reply, 54, told.server == 0 ? 3 : 0, 2);
    put(reply, 56, static_cast<std::uint64_t>(told.heard), 8);
    put(reply, 72, real(-told.behind), 4);
    sendto(fd_.get(), reply.data(), reply.size(), 0, reinterpret_cast<const sockaddr*>(&from), size);
    ++answers;
  }

  loop::FileDescriptor fd_{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  loop::Source asked_;
};

}  // namespace adit::admin
