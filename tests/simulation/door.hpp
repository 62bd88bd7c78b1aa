#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "intake/listen_socket.hpp"

namespace adit::simulation {

class World;

/// The team's side. New connections wait here until a server accepts them, as in the queue of a socket that
/// systemd keeps.
class Door {
 public:
  explicit Door(World& world) : world_(world) {}
  ~Door();
  Door(const Door&) = delete;
  Door& operator=(const Door&) = delete;

  /// Returns the client's non-blocking end of a new connection from `address` (IPv4).
  int connect(const std::string& address);
  /// Sets the interface that the settings name for the team; "": any.
  void belongs_to(std::string interface) { interface_ = std::move(interface); }
  /// Gives the connections to a server, until the token is destroyed.
  std::shared_ptr<void> open(int listening, intake::Admit admit);
  /// Call after the client has closed its end.
  void closed(int fd);
  /// Call after the server has closed its end.
  void server_closed(int fd) { served_.erase(fd); }
  /// Ends the process's connections: clients still hear earlier bytes, but no later ones.
  void cut();

 private:
  struct Waiting {
    int fd, client;
    std::uint32_t address;
  };
  void admit_all();
  /// Checks the limits after a new connection from `address`.
  void count(std::uint32_t address);

  World& world_;
  std::string interface_;
  std::set<int> clients_;  // clients' ends of admitted connections
  struct Served {
    std::uint32_t address;
    int server;
  };
  std::map<int, Served> served_;  // open server ends
  int server_ = 0;                // the server that accepts connections now
  std::deque<Waiting> waiting_;
  intake::Admit admit_;
  std::weak_ptr<void> token_;
};

}  // namespace adit::simulation
