#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <vector>

namespace adit::applier {

/// Somebody else who has an address.
struct Claim {
  std::uint32_t address = 0;
  std::string mac;
  std::string own;  // the interface of this very machine that has this MAC address; "": it is another machine
};

/// Asks on `interface` whether anybody else has one of `addresses`, by ARP (RFC 5227 2.1.1), and waits for
/// answers; needs CAP_NET_RAW. Quicker than the RFC's seconds, which are for a machine that is about to use
/// an address: this one is a test that somebody waits for. An error says what could not be done.
std::expected<std::optional<Claim>, std::string> probe(const std::string& interface,
                                                       const std::vector<std::uint32_t>& addresses);

inline constexpr int kProbes = 3;
inline constexpr std::chrono::milliseconds kBetweenProbes{300}, kAfterProbes{700};

}  // namespace adit::applier
