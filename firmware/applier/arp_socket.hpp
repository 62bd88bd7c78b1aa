#pragma once

#include <linux/if_packet.h>

#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "applier/arp.hpp"
#include "loop/file_descriptor.hpp"

struct sock_filter;

namespace adit::applier {

/// The MAC address of an interface, or why there is none: it is no Ethernet, or is not there.
std::expected<Mac, std::string> mac_of(const std::string& interface);

/// Speaks and hears ARP on one interface; needs CAP_NET_RAW. Errors say what could not be done.
class ArpSocket {
 public:
  /// Hears all ARP of the interface.
  static std::expected<ArpSocket, std::string> open(const std::string& interface);

  /// From now on the kernel gives it only what comes from one of these addresses, or probes for one.
  std::expected<void, std::string> hear_only(const std::vector<std::uint32_t>& addresses);
  /// Asks everybody who has the address.
  std::expected<void, std::string> ask(std::uint32_t address) const;
  /// What has come, its length in bytes; nothing: no more. Does not wait. 0: it was for somebody else, which
  /// is what the kernel makes of the frames of VLANs that the interface is not in.
  std::optional<std::size_t> receive(std::span<std::uint8_t> into) const;

  const Mac& own() const { return own_; }
  int descriptor() const { return socket_.get(); }

 private:
  loop::FileDescriptor socket_;
  sockaddr_ll everybody_{};
  std::string interface_;
  Mac own_{};
};

/// The program of the kernel's (socket(7), SO_ATTACH_FILTER) that hear_only() sets, for what begins with
/// ARP's first byte.
std::vector<sock_filter> arp_filter(const std::vector<std::uint32_t>& addresses);

}  // namespace adit::applier
