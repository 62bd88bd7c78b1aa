#include "host/link_changes.hpp"

#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>

namespace adit::host {
namespace {

/// A socket that receives the kernel's messages to these groups.
loop::FileDescriptor told_to(unsigned groups) {
  loop::FileDescriptor changes(socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_ROUTE));
  sockaddr_nl address{};
  address.nl_family = AF_NETLINK;
  address.nl_groups = groups;
  if (changes && bind(changes.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return {};
  return changes;
}

}  // namespace

loop::FileDescriptor link_changes() {
  return told_to(RTMGRP_LINK);
}
loop::FileDescriptor link_and_address_changes() {
  return told_to(RTMGRP_LINK | RTMGRP_IPV4_IFADDR);
}

/// Discards the messages, because some are lost when too many come at once (ENOBUFS).
bool take_link_changes(const loop::FileDescriptor& changes) {
  constexpr int kMostAtOnce = 64;
  std::array<char, 64> start;
  for (int taken = 0; taken < kMostAtOnce; ++taken) {
    const ssize_t size = recv(changes.get(), start.data(), start.size(), MSG_DONTWAIT);
    if (size == 0) return false;
    if (size > 0 || errno == ENOBUFS || errno == EINTR) continue;
    return errno == EAGAIN;
  }
  return true;
}

}  // namespace adit::host
