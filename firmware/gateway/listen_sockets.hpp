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

/// The sockets at which the team is served. They outlive the process, by exec or by systemd: a client that
/// connects meanwhile waits in the kernel's queue, and is served by the next one.
///
/// The box's own doors are those of systemd's socket unit: they are always served, whatever the settings say,
/// so that the page is reached. So an address that the box does not have yet (a cable that is out, DHCP)
/// keeps nothing from starting where there is a door, and is an error where there is none. The others follow
/// the settings; systemd keeps copies of them in the service's store.
class ListenSockets {
 public:
  ListenSockets() = default;
  /// Takes over what systemd gave. An error: one of the socket unit's is none to listen with.
  static std::expected<ListenSockets, std::string> take_over(std::vector<host::Inherited> given);

  /// A copy of one to serve, and where it listens.
  struct Open {
    std::uint64_t number = 0;  // the socket's: no two of a process alike
    loop::FileDescriptor socket;
    intake::Bound at;
  };
  /// One for each of `team.listen`, unless one of the box's doors covers it, and the doors. Those at places
  /// that are not named any more are closed where they are in the way. An error says what cannot be listened
  /// at.
  std::expected<std::vector<Open>, std::string> open(const settings::Team& team);

  /// How those are reached that are bound to an interface. An adapter that is pulled and plugged in again
  /// comes back as another interface of the same name.
  enum class Reach : std::uint8_t {
    Well,       // also where the interface is still away
    Reopen,     // they have to be opened again
    BySystemd,  // by systemd, for they are the box's doors: the process has to restart
  };
  Reach reach() const;

  /// Those that the next start of the process gets from this one, as systemd would give them. Ends this.
  std::vector<host::Inherited> hand_over();

  /// What open() was told last is what counts: the others are closed for good, these are kept by systemd.
  void settle();

 private:
  struct Held {
    std::uint64_t number = 0;
    std::string name;  // the store's, which says what it was opened for; a door's: the unit's
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
