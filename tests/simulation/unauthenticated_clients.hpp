#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// Clients without a token that hold connections. From four addresses they begin a log-in on each
/// connection, send a byte now and then, and reconnect if they are cut.
class UnauthenticatedClients {
 public:
  UnauthenticatedClients(World& world, double until);
  ~UnauthenticatedClients();
  UnauthenticatedClients(const UnauthenticatedClients&) = delete;
  UnauthenticatedClients& operator=(const UnauthenticatedClients&) = delete;

 private:
  struct Socket {
    std::string address;
    int fd = -1;
    std::uint64_t watch = 0;
  };
  void connect(Socket& socket);
  void close(Socket& socket);
  void send_a_byte(Socket& socket);
  void read(Socket& socket);

  World& world_;
  Random random_;
  const double until_;
  std::vector<std::unique_ptr<Socket>> sockets_;
};

}  // namespace adit::simulation
