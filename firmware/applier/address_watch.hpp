#pragma once

#include <array>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "applier/arp_socket.hpp"
#include "applier/exchanged.hpp"
#include "applier/options.hpp"
#include "applier/sought.hpp"
#include "applier/takers.hpp"
#include "host/root_program.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "network/messages.hpp"

namespace adit::applier {

/// Listens, as long as the box is on, whether another machine uses an address of its two interfaces, and
/// whether the Command Post is at the team's port, and tells so in network::kTakenFile. Interfaces may come
/// and go.
class AddressWatch {
 public:
  /// Packets that are read at once. Where more come, they rest so long: what floods the box is dropped by the
  /// kernel, and costs no processor.
  static constexpr int kMostAtOnce = 64;
  static constexpr std::chrono::milliseconds kRest{100};
  /// Between two writings of the file, and between two lines of the log about an interface.
  static constexpr std::chrono::seconds kBetweenTellings{1}, kBetweenLines{60};

  /// Both outlive this.
  AddressWatch(loop::Loop& loop, const Options& options);

  /// An error: nothing would ever be heard, or told.
  std::expected<void, std::string> start();

 private:
  using Instant = Takers::Instant;

  struct Side {
    std::string interface;
    unsigned index = 0;  // of the one that is listened on; 0: none
    bool carrier = false;
    std::string trouble = {};  // why nothing is heard; ""
    Takers takers = {};
    std::optional<Instant> rests_until = {};
    std::optional<Instant> said_at = {};   // in the log
    std::vector<std::uint32_t> said = {};  // that these are taken
    std::optional<ArpSocket> arp = {};
    loop::Source heard = {};  // ended before its descriptor is closed
  };

  Side& team() { return sides_.front(); }
  Side& post() { return sides_.back(); }
  void look();
  void look(Side& side, const std::vector<Mac>& macs, const std::vector<std::uint32_t>& sought);
  void open(Side& side, unsigned index);
  void hear(Side& side);
  void work();
  static void ask(const Side& side, const std::vector<std::uint32_t>& addresses);
  static void say(Side& side, Instant now);
  void tell(Instant now);
  network::Taken taken(Instant now) const;

  loop::Loop& loop_;
  std::array<Side, 2> sides_;
  Exchanged exchanged_;
  ToldStatus told_;
  host::StatusFile file_;
  std::optional<Instant> written_at_;
  const loop::FileDescriptor kernel_;
  loop::Source changed_, due_;
};

}  // namespace adit::applier
