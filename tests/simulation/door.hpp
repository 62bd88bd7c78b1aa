#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <set>
#include <string>

#include "intake/accept.hpp"

namespace adit::simulation {

class World;

/// The team's side: who connects waits here until a server takes connections, as in the queue of a socket
/// that systemd keeps.
class Door {
 public:
  explicit Door(World& world) : world_(world) {}
  ~Door();
  Door(const Door&) = delete;
  Door& operator=(const Door&) = delete;

  /// The client's end of a new connection from `address` (IPv4). It is not blocking.
  int connect(const std::string& address);
  /// A server takes connections until the token is let go of.
  std::shared_ptr<void> open(intake::Admit admit);
  /// The client has closed its end.
  void closed(int fd);
  /// The server did not take in the client's connection: its address had as many as it may.
  bool has_refused(int fd) const { return refused_.contains(fd); }
  /// The process is over: what it said before is still heard, and nothing of what it says now.
  void cut();

 private:
  struct Waiting {
    int fd, client;
    std::uint32_t address;
  };
  void admit_all();

  World& world_;
  std::set<int> clients_;  // their ends of connections that were admitted
  std::set<int> refused_;  // and of those that were closed at once
  std::deque<Waiting> waiting_;
  intake::Admit admit_;
  std::weak_ptr<void> token_;
};

}  // namespace adit::simulation
