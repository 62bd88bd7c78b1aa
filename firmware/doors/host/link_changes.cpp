#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>

#include "host/files.hpp"
#include "host/interfaces.hpp"
#include "host/service.hpp"

namespace adit::host {

std::optional<bool> carrier_in(const std::string& sys_class_net, const std::string& interface) {
  if (!is_interface_name(interface)) return std::nullopt;
  const auto file = slurp(sys_class_net + "/" + interface + "/carrier");
  if (file) return file->text.starts_with('1');
  if (file.error() == EINVAL) return false;  // an interface that is down has no carrier
  return std::nullopt;
}

std::optional<bool> carrier(const std::string& interface) {
  return interface.empty() ? true : carrier_in("/sys/class/net", interface);
}

namespace {

/// A socket that receives the kernel's messages to these groups.
loop::FileDescriptor open_netlink(unsigned groups) {
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
  return open_netlink(RTMGRP_LINK);
}
loop::FileDescriptor link_and_address_changes() {
  return open_netlink(RTMGRP_LINK | RTMGRP_IPV4_IFADDR);
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
