#pragma once

#include <array>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "applier/arp.hpp"
#include "applier/conflict_detector.hpp"
#include "applier/options.hpp"
#include "host/root_program.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "network/messages.hpp"

namespace adit::applier {

/// Listens for address conflicts on the box's two interfaces and for the Command Post at the team's port, and
/// writes them to network::kTakenFile. Runs until the box stops. Interfaces may come and go.
class AddressWatch {
 public:
  /// Packets read at once, and the pause after as many. In a flood the kernel drops packets, which costs no
  /// CPU time here.
  static constexpr int kMostAtOnce = 64;
  static constexpr std::chrono::milliseconds kRest{100};
  /// Least time between two writes of the file, and between two log lines about an interface.
  static constexpr std::chrono::seconds kBetweenTellings{1}, kBetweenLines{60};
  static constexpr std::chrono::seconds kLookAgain{10};  // after an error

  /// Both must outlive this object.
  AddressWatch(loop::Loop& loop, const Options& options);

  /// Error: the watch cannot hear packets or write the file.
  std::expected<void, std::string> start();

 private:
  using Instant = ConflictDetector::Instant;

  struct Side {
    std::string interface;
    unsigned index = 0;  // of the interface listened on; 0: not listening
    bool carrier = false;
    std::string trouble = {};  // why it cannot listen, or ""
    ConflictDetector takers = {};
    std::optional<Instant> rests_until = {};
    std::optional<Instant> said_at = {};   // last log line
    std::vector<std::uint32_t> said = {};  // addresses logged as in conflict
    std::optional<ArpSocket> arp = {};
    loop::Source heard = {};  // destroyed before its descriptor is closed
  };

  Side& team() { return sides_.front(); }
  Side& post() { return sides_.back(); }
  /// Reads addresses and interfaces. After an error, watches the last known addresses and tries again.
  void look();
  std::expected<void, std::string> try_to_look();
  void look(Side& side, const std::vector<settings::Subnet>& own, const std::vector<Mac>& macs,
            const std::vector<std::uint32_t>& sought);
  void open(Side& side, unsigned index);
  void hear(Side& side);
  void work();
  static void ask(const Side& side, const std::vector<std::uint32_t>& addresses);
  static void say(Side& side, Instant now);
  void tell(Instant now);
  network::AddressConflicts taken(Instant now) const;

  loop::Loop& loop_;
  std::array<Side, 2> sides_;
  SwappedCables exchanged_;
  ToldStatus told_;
  host::StatusFile file_;
  std::optional<Instant> written_at_;
  const loop::FileDescriptor kernel_;
  loop::Source changed_, due_, again_;
};

}  // namespace adit::applier
