#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "applier/arp.hpp"

namespace adit::applier {

/// Who uses addresses on one interface where no other machine is to have them, as are the box's own, by what
/// is heard of ARP there (RFC 5227 2.4), and when to ask for it: as an address or a cable comes, after
/// somebody else asked for an address, and again and again only while it is taken. Holds one machine for each
/// address, and asks as seldom however much is heard: whoever sends what he likes fills nothing.
class Takers {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kMost = 16;  // addresses; what is beyond is not watched
  /// Between the first questions for an address. One may be lost (PROBE_NUM of RFC 5227 1.1), and a switch
  /// may let nothing through for the first 30 s of a cable (twice its forward delay, IEEE 802.1D).
  static constexpr std::array kFirstGaps = {std::chrono::seconds{1}, std::chrono::seconds{1},
                                            std::chrono::seconds{13}, std::chrono::seconds{20}};
  static constexpr std::chrono::seconds kBetween{5};  // of one address, where there is a cause

  /// An address that another machine uses.
  struct Taken {
    std::uint32_t address = 0;
    Mac by{};  // the one that was heard first, as long as it is heard
    Instant since{}, seen{};
    friend bool operator==(const Taken&, const Taken&) = default;
  };

  /// What is to be nobody else's there from now on, and the MAC addresses that are this machine's.
  void set_own(const std::vector<std::uint32_t>& addresses, std::vector<Mac> macs, Instant now);
  /// The cable came: whoever is at its end may have one of the addresses.
  void ask_again(Instant now);
  void hear(const ArpPacket& packet, Instant now);
  /// Those to be asked for now, each once; and what was not heard for network::kTakenFor is taken no more.
  std::vector<std::uint32_t> take_due(Instant now);
  /// When take_due() is to be called.
  std::optional<Instant> wake() const;

  std::vector<Taken> taken() const;

 private:
  struct Own {
    std::uint32_t address = 0;
    std::size_t first_asks = 0;  // that are left
    std::optional<Instant> ask_at = {}, asked_at = {};
    std::optional<Taken> taken = {};
    Instant by_seen{};  // when the one that is named was heard, last
  };
  static void note(Own& own, const Mac& by, Instant now);
  static void ask_soon(Own& own, Instant now);

  std::vector<Own> own_;
  std::vector<Mac> macs_;
};

}  // namespace adit::applier
