#pragma once

#include <cstdint>
#include <vector>

#include "applier/takers.hpp"

namespace adit::applier {

/// Detects exchanged cables by ARP: addresses of the Command Post answer at the team's port and not at their
/// own. Requests at the Command Post's own port are sent only after an answer at the team's port.
class Exchanged {
 public:
  using Instant = Takers::Instant;

  /// Least time between the first and the last sighting, so that one forged packet proves nothing.
  static constexpr std::chrono::seconds kSure{4};

  /// `addresses`: the Command Post's, outside the team's subnet. `macs`: of this machine.
  void set_sought(const std::vector<std::uint32_t>& addresses, const std::vector<Mac>& macs, Instant now);
  /// Call when the team's cable is plugged in, which may be the wrong one.
  void ask_again(Instant now) { at_team_.ask_again(now); }
  void hear_at_team(const ArpPacket& packet, Instant now) { at_team_.hear(packet, now); }
  void hear_at_post(const ArpPacket& packet, Instant now);

  /// Addresses to ask for now.
  struct Due {
    std::vector<std::uint32_t> at_team, at_post;
  };
  Due take_due(Instant now);
  std::optional<Instant> wake() const { return at_team_.wake(); }

  /// The Command Post's addresses seen at the team's port alone.
  std::vector<Takers::Taken> found(Instant now) const;

 private:
  /// An address and its last sighting at its own port.
  struct AtPost {
    std::uint32_t address = 0;
    std::optional<Instant> seen = {};
  };

  Takers at_team_;
  std::vector<AtPost> at_post_;
  std::vector<Mac> macs_;
};

}  // namespace adit::applier
