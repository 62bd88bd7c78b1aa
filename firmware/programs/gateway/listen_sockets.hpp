#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <vector>

#include "host/inherited.hpp"
#include "intake/listen_socket.hpp"
#include "loop/file_descriptor.hpp"
#include "settings/settings.hpp"

namespace adit::gateway {

/// The team's listening sockets. They survive a restart by exec or by systemd. Clients that connect meanwhile
/// wait in the kernel's queue.
///
/// The sockets of systemd's unit are the box's doors. They are always served, whatever the settings say, so
/// that the page is reachable. With a door, a missing address (unplugged cable, DHCP) does not prevent a
/// start; without a door it is an error. The other sockets follow the settings, and systemd stores copies.
class ListenSockets {
 public:
  ListenSockets() = default;
  /// An error: a socket of the unit cannot listen.
  static std::expected<ListenSockets, std::string> take_over(std::vector<host::Inherited> given);

  /// A copy to serve, and its place.
  struct Open {
    std::uint64_t number = 0;  // unique in the process
    loop::FileDescriptor socket;
    intake::Bound at;
  };
  /// Opens one for each of `team.listen` that no door covers, and the doors. Closes unnamed sockets that are
  /// in the way. An error names the address.
  std::expected<std::vector<Open>, std::string> open(const settings::Team& team);

  /// State of sockets that are bound to an interface. A re-plugged adapter is another interface of the same
  /// name.
  enum class Reach : std::uint8_t {
    Well,       // or its interface is absent
    Reopen,     // to be opened again
    BySystemd,  // a door: the process must restart
  };
  Reach reach() const;

  /// The sockets for the next process, as from systemd. Ends this object.
  std::vector<host::Inherited> hand_over();

  /// Confirms the last open(): closes the other sockets, and stores these at systemd.
  void settle();

 private:
  struct Held {
    std::uint64_t number = 0;
    std::string name;  // in systemd's store, or of the unit's door
    loop::FileDescriptor socket;
    intake::Bound at;
    bool door = false;
    bool stored = false;
    bool wanted = false;
  };

  bool is_held(const intake::Listen& listen);
  void make_way(std::uint16_t port);
  static void end(const Held& held);

  std::vector<Held> held_;
  std::uint64_t last_ = 0;
};

}  // namespace adit::gateway
