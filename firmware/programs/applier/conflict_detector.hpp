#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "applier/arp.hpp"

namespace adit::applier {

/// Finds machines that use addresses reserved on one interface, such as the box's own, from received ARP (RFC
/// 5227 2.4). Decides when to ask: after an address or a cable comes, after another machine probes for an
/// address, and repeatedly during a conflict. Stores one machine for each address and limits the rate of
/// requests, so a flood of packets uses no more memory or bandwidth.
class ConflictDetector {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kMost = 16;  // addresses; more are not watched
  /// Gaps between the first requests for an address. A packet may be lost (PROBE_NUM of RFC 5227 1.1), and a
  /// switch may block a new cable for 30 s (twice its forward delay, IEEE 802.1D).
  static constexpr std::array kFirstGaps = {std::chrono::seconds{1}, std::chrono::seconds{1},
                                            std::chrono::seconds{13}, std::chrono::seconds{20}};
  static constexpr std::chrono::seconds kBetween{5};  // least gap between requests for one address

  /// An address that another machine uses.
  struct Conflict {
    std::uint32_t address = 0;
    Mac by{};  // the first machine, while it is heard
    Instant since{}, seen{};
    friend bool operator==(const Conflict&, const Conflict&) = default;
  };

  /// `addresses`: those that no other machine may have. `macs`: of this machine.
  void set_own(const std::vector<std::uint32_t>& addresses, std::vector<Mac> macs, Instant now);
  /// Call when the cable is plugged in: the machine at its end may have an address.
  void ask_again(Instant now);
  void hear(const ArpPacket& packet, Instant now);
  /// Addresses to ask for now, without duplicates. Ends conflicts not seen for network::kTakenFor.
  std::vector<std::uint32_t> take_due(Instant now);
  /// Time of the next take_due().
  std::optional<Instant> wake() const;

  std::vector<Conflict> taken() const;

 private:
  struct Own {
    std::uint32_t address = 0;
    std::size_t first_asks = 0;  // first requests left
    std::optional<Instant> ask_at = {}, asked_at = {};
    std::optional<Conflict> taken = {};
    Instant by_seen{};  // last packet of taken->by
  };
  static void note(Own& own, const Mac& by, Instant now);
  static void ask_soon(Own& own, Instant now);

  std::vector<Own> own_;
  std::vector<Mac> macs_;
};

}  // namespace adit::applier
