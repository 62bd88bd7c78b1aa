#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

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
  /// The settings name that interface for the team; "": any.
  void belongs_to(std::string interface) { interface_ = std::move(interface); }
  /// A server that listens there takes connections until the token is let go of.
  std::shared_ptr<void> open(int listening, intake::Admit admit);
  /// The client has closed its end.
  void closed(int fd);
  /// The server has closed its end.
  void server_closed(int fd) { served_.erase(fd); }
  /// The process is over: what it said before is still heard, and nothing of what it says now.
  void cut();

 private:
  struct Waiting {
    int fd, client;
    std::uint32_t address;
  };
  void admit_all();
  /// The connections, of which one of `address` came just before.
  void count(std::uint32_t address);

  World& world_;
  std::string interface_;
  std::set<int> clients_;  // their ends of connections that were admitted
  struct Served {
    std::uint32_t address;
    int server;
  };
  std::map<int, Served> served_;  // the servers' ends that are open
  int server_ = 0;                // the one that takes connections now
  std::deque<Waiting> waiting_;
  intake::Admit admit_;
  std::weak_ptr<void> token_;
};

}  // namespace adit::simulation
