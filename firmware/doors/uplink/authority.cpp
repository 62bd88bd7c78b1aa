#include "uplink/socket.hpp"

namespace adit::uplink {

std::string authority_of(const Endpoint& endpoint) {
  // A zone ("fe80::1%darpa0") has a meaning on this machine only (RFC 6874 4).
  const std::string address = endpoint.address.substr(0, endpoint.address.find('%'));
  const bool is_ipv6 = address.find(':') != std::string::npos;
  return (is_ipv6 ? "[" + address + "]" : address) + ":" + std::to_string(endpoint.port);
}

}  // namespace adit::uplink
