#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "applier/arp.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "network/messages.hpp"

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
  void restart_probing(Instant now);
  void on_packet(const ArpPacket& packet, Instant now);
  /// Addresses to ask for now, without duplicates. Ends conflicts not seen for network::kTakenFor.
  std::vector<std::uint32_t> pop_due(Instant now);
  /// Time of the next pop_due().
  std::optional<Instant> wake() const;

  std::vector<Conflict> conflicts() const;

 private:
  struct WatchedAddress {
    std::uint32_t address = 0;
    std::size_t first_asks = 0;  // first requests left
    std::optional<Instant> ask_at = {}, asked_at = {};
    std::optional<Conflict> taken = {};
    Instant by_seen{};  // last packet of taken->by
  };
  static void note(WatchedAddress& own, const Mac& by, Instant now);
  static void schedule_probe(WatchedAddress& own, Instant now);

  std::vector<WatchedAddress> own_;
  std::vector<Mac> macs_;
};

/// Addresses that answer on the link for the Command Post's endpoints: the endpoints or their gateway.
/// Sorted, without duplicates, at most ConflictDetector::kMost. `own`: the box's addresses on that side, used
/// if adit-network has none. Addresses in a subnet of `team` are left out, because a robot may have them.
std::vector<std::uint32_t> sought_in(const network::Status& status, const std::vector<settings::Subnet>& own,
                                     const std::vector<settings::Subnet>& team);

/// adit-network's status, read by another program, with notices of changes.
class StatusReader {
 public:
  /// `folder`: of adit-network; may appear later. `changed` is called after each possible change. `loop` must
  /// outlive this object.
  StatusReader(loop::Loop& loop, std::string folder, std::function<void()> changed);

  /// Without a status: no endpoints. Unreadable: logs that once, returns the last one, calls `changed` later.
  const network::Status& read();

 private:
  /// Interval of looks for a missing directory or a readable status.
  static constexpr std::chrono::seconds kLookAgain{10};
  void watch_folder();

  loop::Loop& loop_;
  const std::string folder_;
  const std::function<void()> changed_;
  loop::FileDescriptor notices_;
  loop::Source noticed_, due_;
  network::Status status_;
  std::string trouble_;  // why the last read failed, or ""
};

/// Detects exchanged cables by ARP: addresses of the Command Post answer at the team's port and not at their
/// own. Requests at the Command Post's own port are sent only after an answer at the team's port.
class SwappedCables {
 public:
  using Instant = ConflictDetector::Instant;

  /// Least time between the first and the last sighting, so that one forged packet proves nothing.
  static constexpr std::chrono::seconds kSure{4};

  /// `addresses`: the Command Post's, outside the team's subnet. `macs`: of this machine.
  void set_sought(const std::vector<std::uint32_t>& addresses, const std::vector<Mac>& macs, Instant now);
  /// Call when the team's cable is plugged in, which may be the wrong one.
  void restart_probing(Instant now) { at_team_.restart_probing(now); }
  void on_team_packet(const ArpPacket& packet, Instant now) { at_team_.on_packet(packet, now); }
  void on_command_post_packet(const ArpPacket& packet, Instant now);

  /// Addresses to ask for now.
  struct DueProbes {
    std::vector<std::uint32_t> at_team, at_post;
  };
  DueProbes pop_due(Instant now);
  std::optional<Instant> wake() const { return at_team_.wake(); }

  /// The Command Post's addresses seen at the team's port alone.
  std::vector<ConflictDetector::Conflict> conflicts(Instant now) const;

 private:
  /// An address and its last sighting at its own port.
  struct Sighting {
    std::uint32_t address = 0;
    std::optional<Instant> seen = {};
  };

  ConflictDetector at_team_;
  std::vector<Sighting> at_post_;
  std::vector<Mac> macs_;
};

}  // namespace adit::applier
