#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <vector>

namespace adit::applier {

/// Another machine's claim to an address.
struct Claim {
  std::uint32_t address = 0;
  std::string mac;
  std::string own;  // this machine's interface with that MAC address; "": another machine
};

/// Asks on `interface` by ARP (RFC 5227 2.1.1) whether another machine has one of `addresses`. Blocks for
/// answers; needs CAP_NET_RAW. The test is shorter than the RFC's, which is for a machine about to use an
/// address, because a user waits for it. Error: the test failed.
std::expected<std::optional<Claim>, std::string> probe(const std::string& interface,
                                                       const std::vector<std::uint32_t>& addresses);

inline constexpr int kProbes = 3;
inline constexpr std::chrono::milliseconds kBetweenProbes{300}, kAfterProbes{700};

}  // namespace adit::applier
