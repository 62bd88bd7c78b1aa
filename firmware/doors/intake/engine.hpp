#pragma once

#include <cstdint>
#include <string>

#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::intake {

class Client;

/// The server as a Client sees it.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual loop::Instant now() const = 0;
  virtual const Listen& listen() const = 0;
  /// Runs libmicrohttpd soon, from the loop. Call this after each change that libmicrohttpd cannot see.
  virtual void run_soon() = 0;
  /// Makes the server check its clients' deadlines at `when` or earlier.
  virtual void look_at(loop::Instant when) = 0;
  virtual void tell(Ended why, const std::string& address) = 0;
  /// Calls hold_back() of the client `number` after libmicrohttpd has run.
  virtual void hold_back_soon(std::uint64_t number) = 0;
  /// The gate has let in a request.
  virtual void begin_request(Client& client) = 0;
};

}  // namespace adit::intake
