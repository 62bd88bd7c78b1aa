#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// Somebody without a token who holds sockets: from four addresses he begins a log-in on each connection,
/// sends a byte of it now and then, and comes again where he is sent away.
class Strangers {
 public:
  Strangers(World& world, double until);
  ~Strangers();
  Strangers(const Strangers&) = delete;
  Strangers& operator=(const Strangers&) = delete;

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
