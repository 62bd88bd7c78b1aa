#pragma once

#include <cstdint>
#include <string>

namespace adit::rehearsal {

/// A numeric IPv4 or IPv6 address and a TCP port; port 0: any that is free.
struct Address {
  std::string host;
  std::uint16_t port = 0;

  /// "127.0.0.1:8000", "[::1]:8000".
  std::string text() const {
    const bool v6 = host.find(':') != std::string::npos;
    return (v6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
  }
};

}  // namespace adit::rehearsal
