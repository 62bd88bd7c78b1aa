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

/// The MAC address of an interface. Error: the interface is absent or not Ethernet.
std::expected<Mac, std::string> mac_of(const std::string& interface);

/// Sends and receives ARP on one interface; needs CAP_NET_RAW.
class ArpSocket {
 public:
  /// Receives all ARP of the interface.
  static std::expected<ArpSocket, std::string> open(const std::string& interface);

  /// Makes the kernel pass only packets from these addresses and probes for them.
  std::expected<void, std::string> hear_only(const std::vector<std::uint32_t>& addresses);
  /// Broadcasts a request for the address.
  std::expected<void, std::string> ask(std::uint32_t address) const;
  /// Length of the next packet, or std::nullopt if there is no more. Does not block. 0: a packet for another
  /// receiver, which the kernel makes of frames of other VLANs.
  std::optional<std::size_t> receive(std::span<std::uint8_t> into) const;

  const Mac& own() const { return own_; }
  int descriptor() const { return socket_.get(); }

 private:
  loop::FileDescriptor socket_;
  sockaddr_ll everybody_{};
  std::string interface_;
  Mac own_{};
};

/// The kernel filter of hear_only() (socket(7), SO_ATTACH_FILTER), for data that begins with the ARP header.
std::vector<sock_filter> arp_filter(const std::vector<std::uint32_t>& addresses);

}  // namespace adit::applier
