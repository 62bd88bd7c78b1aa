#pragma once

#include <cstdint>
#include <vector>

#include "applier/takers.hpp"

namespace adit::applier {

/// Whether the box's two cables are exchanged, by what is heard of ARP: the Command Post's addresses are at
/// the team's port, answer there when they are asked for, and are not at their own port. There they are asked
/// for only then: it is silent else.
class Exchanged {
 public:
  using Instant = Takers::Instant;

  /// Between the first that was heard and what is believed: no single packet is, whoever sent it.
  static constexpr std::chrono::seconds kSure{4};

  /// The Command Post's from now on, none of which is in a subnet of the team's, and the MAC addresses that
  /// are this machine's.
  void set_sought(const std::vector<std::uint32_t>& addresses, const std::vector<Mac>& macs, Instant now);
  /// The team's cable came: the other one may be in its place.
  void ask_again(Instant now) { at_team_.ask_again(now); }
  void hear_at_team(const ArpPacket& packet, Instant now) { at_team_.hear(packet, now); }
  void hear_at_post(const ArpPacket& packet, Instant now);

  /// Those to be asked for now.
  struct Due {
    std::vector<std::uint32_t> at_team, at_post;
  };
  Due take_due(Instant now);
  std::optional<Instant> wake() const { return at_team_.wake(); }

  /// The Command Post's that are at the team's port alone.
  std::vector<Takers::Taken> found(Instant now) const;

 private:
  /// One that was heard where it belongs.
  struct AtPost {
    std::uint32_t address = 0;
    std::optional<Instant> seen = {};
  };

  Takers at_team_;
  std::vector<AtPost> at_post_;
  std::vector<Mac> macs_;
};

}  // namespace adit::applier
