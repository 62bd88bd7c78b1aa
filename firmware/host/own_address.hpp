#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace adit::host {

struct OwnAddress {
  std::uint32_t address = 0;  // IPv4; 10.0.0.1 is 0x0a000001
  std::uint8_t prefix = 0;
};

/// The first IPv4 address of an interface; nothing where it has none, or there is no such interface. By
/// ioctl, as the service may use no netlink.
std::optional<OwnAddress> own_address(const std::string& interface);

}  // namespace adit::host
